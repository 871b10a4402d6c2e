#include "checks.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace tether::audit {
namespace {

using record::Battery;
using record::BatteryReading;
using Entry = record::Logged<record::Interaction>;

void check(const Entry& entry, const std::vector<const Battery*>& logged, Report& report) {
  const BatteryReading& read = *entry.message.battery;
  const SimTime at = entry.message.st_at_release;
  const auto after = std::ranges::upper_bound(logged, at, {}, &Battery::at);
  if (after == logged.begin())
    return report.add(0, entry, "a battery was read that the record does not have");
  const Battery& before = **std::prev(after);
  const BatteryReading then{before.voltage_V, before.current_A, before.charge};
  // Between two messages of the channel, only the charge is known to lie between theirs.
  const double least = after == logged.end() ? 0.0 : (*after)->charge;
  if (before.at == at ? read != then : !(read.charge >= least && read.charge <= before.charge))
    report.add(1, entry,
               "{} V, {} A and a charge of {} were read at ST {}, but the battery had {} V, {} A "
               "and {} at ST {}",
               read.voltage_V, read.current_A, read.charge, ns(at), then.voltage_V, then.current_A,
               then.charge, ns(before.at));
}

}  // namespace

void check_battery(const record::Record& record, Report& report) {
  std::map<std::string, std::vector<const Battery*>> logged;
  for (const auto& battery : record.batteries)
    logged[battery.message.uav].push_back(&battery.message);
  for (const Entry& entry : record.interactions) {
    if (entry.message.battery.has_value() != (entry.message.kind == record::kBattery))
      report.add(0, entry, "a {} {} a reading of the battery", entry.message.kind,
                 entry.message.battery ? "with" : "without");
    if (entry.message.battery) check(entry, logged[entry.message.uav], report);
  }
}

}  // namespace tether::audit
