#pragma once

#include "camera/camera_device.h"
#include "clock.h"
#include "iio/imu_device.h"
#include "iio/range_device.h"

#include <memory>
#include <mutex>
#include <string_view>
#include <variant>
#include <vector>

#include <tether/client/vehicle.h>
#include <tether/uav/catalogue.h>

namespace tether::devices {

/// In the order of uav::SensorKind.
using Device = std::variant<std::unique_ptr<CameraDevice>, std::unique_ptr<ImuDevice>,
                            std::unique_ptr<RangeDevice>>;

/// Devices behind the interface of a UAV (rig.h says what each call does).
class RigVehicle final : public client::Vehicle {
 public:
  /// `devices` are those of the catalogue's sensors, in its order; `time` is what they were opened
  /// with, and its clock `clock`.
  RigVehicle(std::unique_ptr<Clock> clock, const Timeline& time, uav::Catalogue catalogue,
             std::vector<Device> devices);

  ExecTime now() const override { return time_.now(); }
  const uav::Catalogue& catalogue() const override { return catalogue_; }
  Result<uav::Sample> read_any(std::string_view sensor, uav::SensorKind kind,
                               client::Read read) override;
  Status command_velocity(const uav::VelocityCommand& command) override;
  Status sleep_for(Duration duration) override;
  Status sleep_until(ExecTime until) override;
  Status annotate(std::string_view, std::string_view) override { return ok_status(); }
  Status finish(bool, std::string_view, std::string_view) override { return ok_status(); }

 private:
  Failure no_such_sensor(std::string_view sensor, uav::SensorKind kind) const;

  std::unique_ptr<Clock> clock_;
  Timeline time_;
  uav::Catalogue catalogue_;
  std::vector<Device> devices_;
  std::mutex calls_;  // a device serves one call at a time
};

}  // namespace tether::devices
