#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <tether/base/time.h>
#include <tether/uav/math.h>

namespace tether::uav {

/// One camera image.
struct CameraSample {
  SimTime sampled_at;       ///< time of the exposure [ST]
  std::uint64_t index = 0;  ///< number of this measurement of the sensor
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t>
      rgb;  ///< height × width × 3, row-major from the top left, sRGB bytes R, G, B
};

/// One measurement of the inertial measurement unit, in its own frame S.
struct ImuSample {
  SimTime sampled_at;
  std::uint64_t index = 0;
  Vec3 angular_velocity_rad_s;  ///< w_WS in S
  Vec3 specific_force_m_s2;     ///< a − g in S: +9.81 along "up" when at rest
  Quat q_WS;  ///< attitude as the IMU's own filter reports it (yaw counter-clockwise from east)
};

/// One rangefinder measurement along the sensor's x axis.
struct RangeSample {
  SimTime sampled_at;
  std::uint64_t index = 0;
  double range_m = std::numeric_limits<double>::infinity();  ///< +inf: nothing within range; −inf:
                                                             ///< closer than the minimum (REP-117)
};

using Sample = std::variant<CameraSample, ImuSample, RangeSample>;

SimTime sampled_at(const Sample& sample);

/// A velocity set-point, held until the next one. Linear velocity is in the heading frame H: x
/// ahead along the heading, y left, z up, for any roll and pitch of the UAV.
struct VelocityCommand {
  Vec3 velocity_H_m_s;
  double yaw_rate_rad_s = 0.0;  ///< counter-clockwise seen from above
  friend bool operator==(const VelocityCommand&, const VelocityCommand&) = default;
};

/// Whether every field is finite and within 100 m/s and 100 rad/s, which no multirotor exceeds.
bool is_valid(const VelocityCommand& command);

}  // namespace tether::uav
