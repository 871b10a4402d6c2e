#include "checks.h"
#include "driver_draws.h"
#include "suts.h"

#include <algorithm>
#include <map>
#include <string>

// Each sample that a SUT read is compared with what its driver must do, by draws of the same keys.
namespace tether::audit {
namespace {

using record::Interaction;
using Entry = record::Logged<Interaction>;

struct SensorStamps {
  const record::SensorInfo& info;
  DriverDraws driver;
  bool is_at_fixed_instants = false;  // periodic, under the barrier
  bool has_open_reads = false;        // a stamp can be limited by one that is not in the record
  Wide last = 0;
};

void check_delivery(const Entry& entry, const SensorStamps& sensor, Report& report) {
  const Interaction& read = entry.message;
  if (sensor.driver.loses(read.sample_index))
    report.add(1, entry, "measurement {} of \"{}\" was read, although its driver loses it",
               read.sample_index, read.sensor);
  const std::uint64_t content = sensor.driver.content_of(read.sample_index);
  const std::uint64_t recorded = read.repeated_index.value_or(read.sample_index);
  if (recorded != content)
    report.add(1, entry, "measurement {} of \"{}\" has the content of measurement {} instead of {}",
               read.sample_index, read.sensor, recorded, content);
}

// Stamps of a sensor do not go back. Those of fixed instants cannot; others are held at the last.
void check_stamp(const Entry& entry, SensorStamps& sensor, Report& report) {
  const Interaction& read = entry.message;
  const Wide stamp = wide(*read.sample_stamp);
  const Wide instant =
      sensor.is_at_fixed_instants
          ? wide(sensor.info.phase) + Wide{read.sample_index} * wide(sensor.info.period)
          : wide(*read.sampled_at);
  const Wide expected = std::max(sensor.last, sensor.driver.stamp(instant, read.sample_index));
  const bool is_held_by_another = sensor.has_open_reads && stamp > expected;
  if (stamp != expected && !is_held_by_another)
    report.add(0, entry, "measurement {} of \"{}\" has the stamp {}, but its driver gives it {}",
               read.sample_index, read.sensor, ns(stamp), ns(expected));
  sensor.last = std::max(sensor.last, stamp);
}

void check_read(const Entry& entry, SensorStamps& sensor, Report& report) {
  const Interaction& read = entry.message;
  const bool has_stamp = read.sample_stamp.has_value();
  const bool needs_stamp = sensor.info.driver && read.sampled_at.has_value();
  if (has_stamp != needs_stamp || (read.repeated_index && !needs_stamp))
    return report.add(0, entry, "sample of \"{}\" {} the stamp of a driver", read.sensor,
                      needs_stamp ? "without" : "with");
  if (!needs_stamp) return;
  check_delivery(entry, sensor, report);
  check_stamp(entry, sensor, report);
}

}  // namespace

// A sample is chosen when its request arrives: of a concurrent SUT, in the order of its requests.
void check_stamps(const record::Record& record, Report& report) {
  const bool is_synchronised = record.header.policy != record::kFreeRunning;
  auto rows = rows_of(record);
  for (auto& [uav, row] : rows) {
    if (row.info->concurrent)
      std::ranges::stable_sort(row.interactions, {},
                               [](const Entry* entry) { return entry->message.sequence; });
    std::map<std::string, SensorStamps> sensors;
    for (const record::SensorInfo& sensor : record.header.sensors) {
      if (sensor.uav != uav) continue;
      const bool is_fixed = is_synchronised && sensor.periodic;
      const SensorStamps stamps{.info = sensor,
                                .driver = DriverDraws(record.header, sensor),
                                .is_at_fixed_instants = is_fixed,
                                .has_open_reads = row.info->concurrent && !is_fixed};
      if (!stamps.driver.is_valid())
        report.add(fmt::format(
            "the driver of \"{}\" of UAV \"{}\" has a probability that is not in [0, 0.99]",
            sensor.name, uav));
      sensors.emplace(sensor.name, stamps);
    }
    for (const Entry* entry : row.interactions) {
      const auto sensor = sensors.find(entry->message.sensor);
      if (entry->message.kind == record::kSensor && sensor != sensors.end())
        check_read(*entry, sensor->second, report);
    }
  }
}

}  // namespace tether::audit
