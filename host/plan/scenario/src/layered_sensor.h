#pragma once

#include "sensors/sensor_key.h"

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
  /// @throws Error(kBadFile) at a key of `layer` that a sensor of this kind does not support.
  /// @pre `layer` outlives the object.
  void lay(const SensorProfile& layer);
  /// After the last layer: sets the sensor's update rate and returns its timing.
  /// @throws Error(kBadFile), at the last layer that set it, about one of two values that exclude
  ///   each other, or that does not fit what the sensor is in SDF.
  uav::SensorTiming finish();
  /// Where its rate was last set.
  const FileLocation& rate_at() const { return rate_at_; }

 private:
  void lay_timing(const SensorProfile& layer);

  sim::Sensor* sensor_;
  Laid laid_;
  uav::SensorTiming timing_;
  FileLocation rate_at_;
  bool is_timed_ = false;  // by a layer
};

}  // namespace tether::scenario
