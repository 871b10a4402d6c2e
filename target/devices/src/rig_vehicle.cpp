#include "rig_vehicle.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace tether::devices {
namespace {

/// 146 years: what can be added to any instant since the machine was started.
constexpr Duration kLongest{std::numeric_limits<std::int64_t>::max() / 2};

Status check(client::Read read) {
  if (read != client::Read::kIfAvailable) return ok_status();
  return Failure{Failure::Kind::kInvalid, "reads of a rig always wait; use kNext or kLatest"};
}

}  // namespace

RigVehicle::RigVehicle(std::unique_ptr<Clock> clock, const Timeline& time, uav::Catalogue catalogue,
                       std::vector<Device> devices)
    : clock_(std::move(clock)),
      time_(time),
      catalogue_(std::move(catalogue)),
      devices_(std::move(devices)) {}

template <class T>
T* RigVehicle::find(std::string_view sensor) {
  const uav::SensorDescription* const found = catalogue_.find_sensor(sensor);
  if (found == nullptr) return nullptr;
  Device& device = devices_[static_cast<std::size_t>(found - catalogue_.sensors.data())];
  auto* const held = std::get_if<std::unique_ptr<T>>(&device);
  return held == nullptr ? nullptr : held->get();
}

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

Result<uav::CameraSample> RigVehicle::read_camera(std::string_view sensor, client::Read read) {
  const std::lock_guard lock(calls_);
  CameraDevice* const device = find<CameraDevice>(sensor);
  if (device == nullptr) return no_such_sensor(sensor, uav::SensorKind::kCamera);
  if (const Status good = check(read); !good) return good.failure();
  return device->read(read);
}

Result<uav::ImuSample> RigVehicle::read_imu(std::string_view sensor, client::Read read) {
  const std::lock_guard lock(calls_);
  ImuDevice* const device = find<ImuDevice>(sensor);
  if (device == nullptr) return no_such_sensor(sensor, uav::SensorKind::kImu);
  if (const Status good = check(read); !good) return good.failure();
  return device->read();
}

Result<uav::RangeSample> RigVehicle::read_range(std::string_view sensor, client::Read read) {
  const std::lock_guard lock(calls_);
  RangeDevice* const device = find<RangeDevice>(sensor);
  if (device == nullptr) return no_such_sensor(sensor, uav::SensorKind::kRange);
  if (const Status good = check(read); !good) return good.failure();
  return device->read();
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
