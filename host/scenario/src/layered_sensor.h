#pragma once

#include <tether/base/error.h>
#include <tether/scenario/profile.h>
#include <tether/sim/world.h>
#include <tether/uav/sensor_timing.h>

namespace tether::scenario {

/// A sensor of the world while layers are laid over it, the lowest first.
class LayeredSensor {
 public:
  /// As SDF has it: periodic at its update rate without delay, or on demand without delay where SDF
  /// gives no rate. @pre `sensor` outlives the object.
  explicit LayeredSensor(sim::Sensor& sensor);

  const sim::Sensor& sensor() const { return *sensor_; }
  /// @throws Error(kBadFile) at a key of `layer` that means nothing to a sensor of this kind.
  void lay(const SensorProfile& layer);
  /// After the last layer: its timing. Tells the sensor its rate.
  /// @throws Error(kBadFile) at the layer that made values that exclude each other.
  uav::SensorTiming finish();

 private:
  void lay_timing(const SensorProfile& layer);
  void lay_model(const SensorProfile& layer, sim::CameraModel& camera);
  void lay_model(const SensorProfile& layer, sim::ImuModel& imu);
  void lay_model(const SensorProfile& layer, sim::RangeModel& range);
  void check(const sim::CameraModel& camera) const;
  void check(const sim::ImuModel&) const {}
  void check(const sim::RangeModel& range) const;

  sim::Sensor* sensor_;
  uav::SensorTiming timing_;
  FileLocation limits_at_;   // what last changed a limit of a rangefinder
  FileLocation shutter_at_;  // what last changed a camera's shutter or period
  bool is_timed_ = false;    // by a layer
};

}  // namespace tether::scenario
