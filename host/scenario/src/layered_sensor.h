#pragma once

#include <tether/base/error.h>
#include <tether/scenario/profile.h>
#include <tether/sim/world.h>
#include <tether/uav/sensor_timing.h>

namespace tether::scenario {

/// A sensor of the world to which layers are applied, the lowest first.
class LayeredSensor {
 public:
  /// Initially as in SDF: periodic at its update rate without delay, or on demand without delay if
  /// SDF gives no rate. @pre `sensor` outlives the object.
  explicit LayeredSensor(sim::Sensor& sensor);

  const sim::Sensor& sensor() const { return *sensor_; }
  /// @throws Error(kBadFile) at a key of `layer` that a sensor of this kind does not support: also
  ///   limits of a camera without depths, antialiasing of one without colours, and noise of a
  ///   segmentation camera.
  void lay(const SensorProfile& layer);
  /// After the last layer: sets the sensor's update rate and returns its timing.
  /// @throws Error(kBadFile), about the sensor, at the last layer that set one of two values that
  ///   exclude each other.
  uav::SensorTiming finish();
  /// Where its rate was last set.
  const FileLocation& rate_at() const { return rate_at_; }

 private:
  void lay_timing(const SensorProfile& layer);
  void lay_model(const SensorProfile& layer, sim::CameraModel& camera);
  void lay_model(const SensorProfile& layer, sim::ImuModel& imu);
  void lay_model(const SensorProfile& layer, sim::RangeModel& range);
  void check(const sim::CameraModel& camera) const;
  void check(const sim::ImuModel&) const {}
  void check(const sim::RangeModel& range) const { check_limits(range.min_m, range.max_m); }
  void check_limits(double min_m, double max_m) const;

  sim::Sensor* sensor_;
  uav::SensorTiming timing_;
  FileLocation rate_at_;
  FileLocation limits_at_;   // where a limit of distances was last set
  FileLocation shutter_at_;  // where a camera's shutter or period was last set
  bool is_timed_ = false;    // by a layer
};

}  // namespace tether::scenario
