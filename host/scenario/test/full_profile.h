#pragma once

#include <string>

namespace tether::scenario {

/// A profile that uses every key.
inline const std::string kFullProfile = R"(name = "rig"
description = "every key"

[sensors.camera]
kind = "camera"
timing = "periodic"
rate_hz = 25
phase_ms = 4
delay = { kind = "empirical", samples_ms = [33.1, 33.4] }
position_m = [0.1, 0.2, -0.05]
rpy_deg = [0, 90, 0]
size_px = [320, 200]
horizontal_fov_deg = 90
exposure_ms = 8
readout_ms = 12.5

[sensors.camera.distortion]
k1 = -0.25
k2 = 0.06
k3 = 0.01
p1 = 0.002
p2 = -0.001

[sensors.camera.noise]
mean = 0.01
stddev = 0.02
bias_mean = 0.03
bias_stddev = 0.04
dynamic_bias_stddev = 0.05
dynamic_bias_correlation_time_s = 60

[sensors.imu]
kind = "imu"
timing = "periodic"
period_ms = 50
delay = { kind = "normal", mean_ms = 4, stddev_ms = 1.5 }
angular_velocity_noise_rad_s = { stddev = 0.001, bias_stddev = 0.002 }
linear_acceleration_noise_m_s2 = { stddev = 0.01 }

[sensors.range]
kind = "range"
timing = "on_demand"
delay = { kind = "constant", ms = 97.7 }
min_m = 0.05
max_m = 3
resolution_m = 0.001
field_of_view_deg = 27
dropout_probability = 0.125
noise_m = { mean = 0.01, stddev = 0.005 }
)";

}  // namespace tether::scenario
