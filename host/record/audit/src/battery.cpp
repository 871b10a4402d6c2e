// The battery by its own model: its voltage follows from charge and current, the energy that was
// spent from the charge that is gone, and the parts that are constant from the time.

#include "checks.h"
#include "suts.h"
#include "tracks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace tether::audit {
namespace {

using record::Battery;
using record::BatteryReading;
using record::EnergyInfo;
using Entry = record::Logged<record::Interaction>;
using Sample = record::Logged<Battery>;

// Of numbers that are added up over a flight.
constexpr double kRounding = 1e-6;
// By how much more than in any message may flow in between.
constexpr double kPeak = 10.0;

class Model {
 public:
  explicit Model(const EnergyInfo& info) : info_(info) {}

  double voltage_V(double charge) const {
    const auto& points = info_.voltage_at_charge;
    std::size_t i = 1;
    while (i + 1 < points.size() && points[i].charge < charge) ++i;
    const auto &from = points[i - 1], &to = points[i];
    return from.voltage_V +
           (to.voltage_V - from.voltage_V) * (charge - from.charge) / (to.charge - from.charge);
  }

  // What the battery loses from one charge to a lower one.
  double energy_J(double from, double to) const {
    double joules = 0.0, at = from;
    for (std::size_t i = info_.voltage_at_charge.size(); i-- > 0 && at > to;) {
      const double next = std::clamp(info_.voltage_at_charge[i].charge, to, at);
      joules += (at - next) * (voltage_V(at) + voltage_V(next)) / 2.0;
      at = next;
    }
    return joules * info_.capacity_C;
  }

 private:
  const EnergyInfo& info_;
};

// How much a SUT had computed at an instant: all of the time from a reply to the next request, or
// on a shared board a part of it.
class BusyTime {
 public:
  explicit BusyTime(const SutRow& row) {
    Wide resumed = 0;
    for (const Entry* entry : row.interactions) {
      const record::Interaction& m = entry->message;
      const Wide end = wide(m.request_at);
      spans_.push_back({resumed, end, m.computed ? wide(*m.computed) : end - resumed});
      resumed = wide(m.reply_at);
    }
    known_until_ = resumed;
  }

  // Of later instants, the record does not have the request.
  Wide known_until() const { return known_until_; }
  // The least and the most until `at`, which is not before an earlier one.
  std::pair<Wide, Wide> range(Wide at) {
    for (; next_ < spans_.size() && spans_[next_].end <= at; ++next_)
      computed_ += spans_[next_].computed;
    if (next_ == spans_.size()) return {computed_, computed_};
    const Span& span = spans_[next_];
    const Wide passed = std::max<Wide>(at - span.begin, 0);
    const Wide waited = span.end - span.begin - span.computed;
    return {computed_ + std::max<Wide>(passed - waited, 0),
            computed_ + std::min(passed, span.computed)};
  }

 private:
  struct Span {
    Wide begin = 0, end = 0, computed = 0;
  };
  std::vector<Span> spans_;
  std::size_t next_ = 0;
  Wide known_until_ = 0, computed_ = 0;
};

class BatteryCheck {
 public:
  BatteryCheck(const SutRow& row, double step_s, Report& report)
      : info_(*row.info->energy),
        model_(info_),
        step_s_(step_s),
        busy_(row),
        counts_work_(!row.info->concurrent),
        report_(report) {}

  void check(const Sample& entry) {
    const Battery& m = entry.message;
    most_A_ = std::max(most_A_, m.current_A);
    const double step_C = m.current_A * step_s_;
    // The current flowed in the step before, at the charge of its beginning.
    const double drop_V = info_.resistance_ohm * m.current_A;
    const double most_V =
        model_.voltage_V(std::min(1.0, m.charge + step_C / info_.capacity_C)) - drop_V;
    check_range(entry, "a voltage", "V", m.voltage_V, model_.voltage_V(m.charge) - drop_V, most_V,
                most_V, m.current_A > 0.0 || m.at == SimTime{});
    const double lost_J = model_.energy_J(info_.initial_charge, m.charge);
    const double sag_V = model_.voltage_V(info_.initial_charge) - model_.voltage_V(m.charge);
    const double peak_C = kPeak * most_A_ * step_s_;
    check_range(entry, "an energy", "J", m.spent_j(), lost_J,
                lost_J + peak_C * (sag_V + (m.charge > 0.0 ? 0.0 : most_V)), lost_J, true);
    check_parts(entry);
  }

 private:
  // What is drawn all the time, up to the step in which the battery was exhausted.
  void check_parts(const Sample& entry) {
    const Battery& m = entry.message;
    const double time_s = to_seconds(m.at.time_since_epoch());
    const bool is_on = m.current_A > 0.0 || m.at == SimTime{};
    for (const auto& [what, joules, watts] :
         {std::tuple("an energy for lift", m.lift_J, info_.lift_W),
          {"an energy for the idle computer", m.idle_J, info_.idle_W},
          {"an energy for sensors", m.sensors_J, info_.sensors_W}})
      check_range(entry, what, "J", joules, is_on ? watts * time_s : 0.0, watts * time_s,
                  watts * time_s, true);
    if (!counts_work_ || wide(m.at) >= busy_.known_until()) return;
    const auto [least, most] = busy_.range(wide(m.at));
    const auto joules = [&](Wide busy) {
      return info_.busy_core_W * static_cast<double>(busy) * 1e-9;
    };
    check_range(entry, "an energy for computing", "J", m.computing_J, is_on ? joules(least) : 0.0,
                joules(most), joules(most), true);
  }

  void check_range(const Sample& entry, const char* what, const char* unit, double value,
                   double least, double most, double scale, bool applies) {
    const double margin = kRounding * (1.0 + std::abs(scale));
    if (applies && !(value >= least - margin && value <= most + margin))
      report_.add(0, entry, "{} of {} {}, but {} to {} {} follow from the battery's model", what,
                  value, unit, least, most, unit);
  }

  const EnergyInfo& info_;
  Model model_;
  double step_s_;
  BusyTime busy_;
  bool counts_work_;
  Report& report_;
  double most_A_ = 0.0;
};

bool is_sound(const EnergyInfo& info) {
  const auto& points = info.voltage_at_charge;
  return info.capacity_C > 0.0 && points.size() > 1 &&
         std::ranges::is_sorted(points, std::ranges::less_equal{}, &record::ChargeVoltage::charge);
}

// Each message has its place with the ground truth of its UAV.
void check_samples(const record::Record& record, Report& report) {
  const double step_s = to_seconds(record.header.step);
  const auto tracks = tracks_of(record);
  std::map<std::string, BatteryCheck> checks;
  const auto rows = rows_of(record);
  for (const auto& [uav, row] : rows) {
    if (!row.info->energy) continue;
    if (is_sound(*row.info->energy))
      checks.try_emplace(uav, row, step_s, report);
    else
      report.add("the model of the battery of \"" + uav + "\" makes no sense");
  }
  const bool is_older = record.header.time_limit <= Duration(0);  // Tether 0.1.0: without models
  if (!is_older && checks.empty() && !record.batteries.empty())
    report.add("batteries without a model");
  for (const Sample& entry : record.batteries) {
    const Battery& m = entry.message;
    const auto track = tracks.find(m.uav);
    const bool is_known = track != tracks.end() && !track->second.truths.empty();
    const record::GroundTruth* truth = is_known ? track->second.at_or_after(m.at) : nullptr;
    if (m.at != entry.at || (is_known && (truth == nullptr || truth->at != m.at)))
      report.add(0, entry, "battery at {}, which is not an instant of the ground truth", ns(m.at));
    if (const auto check = checks.find(m.uav); check != checks.end()) check->second.check(entry);
  }
}

void check_reading(const Entry& entry, const std::vector<const Battery*>& logged, Report& report) {
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
  check_samples(record, report);
  std::map<std::string, std::vector<const Battery*>> logged;
  for (const auto& battery : record.batteries)
    logged[battery.message.uav].push_back(&battery.message);
  for (const Entry& entry : record.interactions) {
    if (entry.message.battery.has_value() != (entry.message.kind == record::kBattery))
      report.add(0, entry, "a {} {} a reading of the battery", entry.message.kind,
                 entry.message.battery ? "with" : "without");
    if (entry.message.battery) check_reading(entry, logged[entry.message.uav], report);
  }
}

}  // namespace tether::audit
