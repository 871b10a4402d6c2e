#include "checks.h"
#include "driver_draws.h"
#include "suts.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>

namespace tether::audit {
namespace {

using record::Interaction;
using Entry = record::Logged<Interaction>;

struct SensorHistory {
  const record::SensorInfo* info = nullptr;
  std::optional<std::uint64_t> newest;  // largest index read
  std::uint64_t last_index = 0;
  Wide last_sampled_at = 0;
  Wide last_available_at = 0;
};

// Each measurement is read once, in order. A read of the latest may repeat it.
void check_index(const Entry& entry, SensorHistory& sensor, Report& report) {
  const Interaction& read = entry.message;
  const Wide sampled = wide(*read.sampled_at);
  const Wide available = wide(*read.available_at);
  const bool may_repeat = read.latest && sensor.info->periodic;
  if (!may_repeat && sensor.newest && read.sample_index <= *sensor.newest)
    report.add(1, entry, "measurement {} of \"{}\" was read after measurement {}",
               read.sample_index, read.sensor, *sensor.newest);
  if (sensor.newest && read.sample_index == sensor.last_index &&
      (sampled != sensor.last_sampled_at || available != sensor.last_available_at))
    report.add(0, entry, "measurement {} has other times than in a previous reading",
               read.sample_index);
  sensor.newest = std::max(sensor.newest.value_or(0), read.sample_index);
  sensor.last_index = read.sample_index;
  sensor.last_sampled_at = sampled;
  sensor.last_available_at = available;
}

// Nothing of the future is skipped.
void check_skip(const Entry& entry, SensorHistory& sensor, Report& report) {
  const std::uint64_t index = *entry.message.skipped_to;
  const Wide sampled = wide(sensor.info->phase) + Wide{index} * wide(sensor.info->period);
  if (sampled > wide(entry.message.request_at))
    report.add(1, entry, "measurement {} of \"{}\" was skipped at {}, before it was sampled at {}",
               index, sensor.info->name, ns(entry.message.request_at), ns(sampled));
  sensor.newest = std::max(sensor.newest.value_or(0), index);
}

// A read without a measurement is correct only if no suitable one was available for certain, even
// with the sensor's largest delay.
void check_missed(const Entry& entry, const SensorHistory& sensor, const DriverDraws& driver,
                  Report& report) {
  const record::SensorInfo& info = *sensor.info;
  const Wide period = wide(info.period);
  if (!info.periodic || period <= 0 || info.delay_max == Duration::max()) return;
  const Wide since_first = wide(entry.message.request_at) - wide(info.phase) - wide(info.delay_max);
  if (since_first < 0) return;
  Wide newest_available = since_first / period;
  const Wide wanted = !entry.message.latest && sensor.newest ? Wide{*sensor.newest} + 1 : Wide{0};
  while (newest_available >= wanted && driver.loses(static_cast<std::uint64_t>(newest_available)))
    --newest_available;
  if (newest_available >= wanted)
    report.add(1, entry, "no measurement at {}, although measurement {} of \"{}\" was available",
               ns(entry.message.request_at), static_cast<std::uint64_t>(newest_available),
               info.name);
}

}  // namespace

// A measurement counts as read at the request that returned it. For a concurrent SUT the order is
// therefore that of its requests.
void check_newness(const record::Record& record, Report& report) {
  auto rows = rows_of(record);
  for (auto& [uav, row] : rows) {
    if (row.info->concurrent) {
      std::ranges::stable_sort(row.interactions, {},
                               [](const Entry* entry) { return entry->message.sequence; });
    }
    std::map<std::string, SensorHistory> sensors;
    for (const record::SensorInfo& sensor : record.header.sensors) {
      if (sensor.uav == uav) sensors[sensor.name].info = &sensor;
    }
    for (const Entry* entry : row.interactions) {
      const auto sensor = sensors.find(entry->message.sensor);
      if (entry->message.kind != record::kSensor || sensor == sensors.end()) {
        continue;
      }
      const bool has_times = entry->message.sampled_at && entry->message.available_at &&
                             entry->message.sample_state_at;
      if (has_times) {
        check_index(*entry, sensor->second, report);
      } else if (entry->message.skipped_to) {
        check_skip(*entry, sensor->second, report);
      } else if (entry->message.only_if_available) {
        check_missed(*entry, sensor->second, DriverDraws(record.header, *sensor->second.info),
                     report);
      }
    }
  }
}

}  // namespace tether::audit
