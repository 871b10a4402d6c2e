#include "camera/open_camera.h"
#include "clock.h"
#include "iio/iio_folder.h"
#include "iio/imu_device.h"
#include "iio/range_device.h"
#include "rig_vehicle.h"

#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <tether/devices/rig.h>

namespace tether::devices {
namespace {

/// "rangefinder iio:vl53l0x"
std::string label_of(const RigSensor& sensor) {
  const uav::SensorKind kind = sensor.description.kind();
  const std::string what = kind == uav::SensorKind::kCamera ? "camera"
                           : kind == uav::SensorKind::kImu  ? "IMU"
                                                            : "rangefinder";
  return what + " " + sensor.device;
}

class Opener {
 public:
  Opener(System& system, const Timeline& time) : system_(system), time_(time) {}

  Result<Device> open(RigSensor& sensor) const {
    switch (sensor.description.kind()) {
      case uav::SensorKind::kCamera:
        return as_device(open_camera(system_, time_, label_of(sensor), sensor));
      case uav::SensorKind::kImu:
        return as_device(imu(sensor));
      default:
        return as_device(rangefinder(sensor));
    }
  }

 private:
  template <class T>
  static Result<Device> as_device(Result<std::unique_ptr<T>> opened) {
    if (!opened) return opened.failure();
    return Device(std::move(*opened));
  }

  Result<std::unique_ptr<RangeDevice>> rangefinder(const RigSensor& sensor) const {
    const std::string label = label_of(sensor);
    const auto folder = find_iio_folder(system_, time_.clock(), label, sensor.device);
    if (!folder) return folder.failure();
    return RangeDevice::open(system_, time_, label, *folder,
                             std::get<uav::RangeProperties>(sensor.description.properties));
  }

  Result<std::unique_ptr<ImuDevice>> imu(const RigSensor& sensor) const {
    const std::string label = label_of(sensor);
    std::vector<std::string> folders;
    const std::size_t comma = sensor.device.find(',');
    std::vector<std::string> devices{sensor.device.substr(0, comma)};
    if (comma != std::string::npos) devices.push_back(sensor.device.substr(comma + 1));
    for (const std::string& device : devices) {
      auto folder = find_iio_folder(system_, time_.clock(), label, device);
      if (!folder) return folder.failure();
      folders.push_back(std::move(*folder));
    }
    return ImuDevice::open(system_, time_, label, folders);
  }

  System& system_;
  const Timeline& time_;
};

}  // namespace

Result<std::unique_ptr<client::Vehicle>> open_rig(Rig rig) {
  auto clock = std::make_unique<MonotonicClock>();
  const Timeline time(*clock);
  const Opener opener(real_system(), time);
  uav::Catalogue catalogue{std::move(rig.uav), {}, std::move(rig.anchors)};
  std::vector<Device> devices;
  for (RigSensor& sensor : rig.sensors) {
    if (catalogue.find_sensor(sensor.description.name) != nullptr) {
      return Failure{Failure::Kind::kInvalid, label_of(sensor) + ": the rig has two sensors \"" +
                                                  sensor.description.name +
                                                  "\"; names must be unique"};
    }
    if (const auto kind = sensor.description.camera_kind();
        kind && *kind != uav::CameraKind::kColor) {
      return Failure{Failure::Kind::kInvalid, label_of(sensor) + ": \"" + sensor.description.name +
                                                  "\" is a " + std::string(uav::name(*kind)) +
                                                  "; a rig has colour cameras only"};
    }
    Result<Device> device = opener.open(sensor);
    if (!device) return device.failure();
    devices.push_back(std::move(*device));
    catalogue.sensors.push_back(std::move(sensor.description));
  }
  return std::unique_ptr<client::Vehicle>(std::make_unique<RigVehicle>(
      std::move(clock), time, std::move(catalogue), std::move(devices)));
}

}  // namespace tether::devices
