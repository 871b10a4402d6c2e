#include "rig_vehicle.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace tether::devices {
namespace {

/// 146 years: what can be added to any instant since the machine was started.
constexpr Duration kLongest{std::numeric_limits<std::int64_t>::max() / 2};

}  // namespace

RigVehicle::RigVehicle(std::unique_ptr<Clock> clock, const Timeline& time, uav::Catalogue catalogue,
                       std::vector<Device> devices)
    : clock_(std::move(clock)),
      time_(time),
      catalogue_(std::move(catalogue)),
      devices_(std::move(devices)) {}

Failure RigVehicle::no_such_sensor(std::string_view sensor, uav::SensorKind kind) const {
  std::string there_is;
  for (const auto& s : catalogue_.sensors) {
    there_is +=
        (there_is.empty() ? "" : ", ") + std::string(uav::name(s.kind())) + " \"" + s.name + "\"";
  }
  return {Failure::Kind::kInvalid, "the rig has no " + std::string(uav::name(kind)) + " \"" +
                                       std::string(sensor) + "\"; it has " +
                                       (there_is.empty() ? "no sensor" : there_is)};
}

Result<uav::Sample> RigVehicle::read_any(std::string_view sensor, uav::SensorKind kind,
                                         client::Read read) {
  const std::lock_guard lock(calls_);
  const uav::SensorDescription* const found = catalogue_.find_sensor(sensor);
  if (found == nullptr || found->kind() != kind) return no_such_sensor(sensor, kind);
  if (read == client::Read::kIfAvailable)
    return Failure{Failure::Kind::kInvalid, "reads of a rig always wait; use kNext or kLatest"};
  const auto as_sample = [](auto measured) -> Result<uav::Sample> {
    if (!measured) return measured.failure();
    return uav::Sample(std::move(*measured));
  };
  return std::visit(
      [&](const auto& device) {
        if constexpr (requires { device->read(read); }) {
          return as_sample(device->read(read));
        } else {
          return as_sample(device->read());
        }
      },
      devices_[static_cast<std::size_t>(found - catalogue_.sensors.data())]);
}

Status RigVehicle::command_velocity(const uav::VelocityCommand&) {
  return Failure{Failure::Kind::kInvalid, "a rig cannot fly; run this task with `tether run`"};
}

Status RigVehicle::sleep_for(Duration duration) {
  return sleep_until(duration < kLongest ? now() + duration : ExecTime(kLongest));
}

Status RigVehicle::sleep_until(ExecTime until) {
  const std::lock_guard lock(calls_);
  clock_->sleep_until(time_.monotonic(std::min(until, ExecTime(kLongest))));
  return ok_status();
}

}  // namespace tether::devices
