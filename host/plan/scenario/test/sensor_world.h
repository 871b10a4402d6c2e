#pragma once

#include <string>
#include <vector>

#include <tether/base/units.h>
#include <tether/sim/world.h>

/// Sensors as SDF could have them, each with something that a profile may change.
namespace tether::scenario {

inline std::vector<double> values_of(const sim::Noise& n) {
  return {n.mean,
          n.stddev,
          n.bias_mean,
          n.bias_stddev,
          n.dynamic_bias_stddev,
          n.dynamic_bias_correlation_time_s};
}

inline sim::Sensor make_camera(const std::string& name, double update_rate_hz = 30.0) {
  sim::CameraModel model;
  model.intrinsics = uav::CameraModel::from_horizontal_fov(640, 480, rad_from_deg(80));
  model.pixel_noise.stddev = 0.007;
  return {name, {{0.1, 0.0, 0.0}, uav::from_rpy(0.0, 0.1, 0.0)}, update_rate_hz, model};
}

inline sim::Sensor make_imu(const std::string& name, double update_rate_hz = 20.0) {
  sim::ImuModel model;
  model.angular_velocity[2].stddev = 0.5;
  model.linear_acceleration[0].bias_mean = 0.1;
  return {name, {}, update_rate_hz, model};
}

inline sim::Sensor make_range(const std::string& name, double update_rate_hz = 30.0) {
  sim::RangeModel model;
  model.min_m = 0.04;
  model.max_m = 4.0;
  model.resolution_m = 0.001;
  model.noise.stddev = 0.005;
  return {name, {{0.1, 0.0, -0.02}, {}}, update_rate_hz, model};
}

}  // namespace tether::scenario
