#pragma once

#include <cstdint>
#include <vector>

#include <tether/base/time.h>

/// What was commanded, as messages of a record have it.
namespace tether::record {

/// A velocity in the heading frame H, and a yaw rate.
struct VelocityCommand {
  double vx_H_m_s = 0, vy_H_m_s = 0, vz_H_m_s = 0, yaw_rate_rad_s = 0;
  friend bool operator==(const VelocityCommand&, const VelocityCommand&) = default;
};

/// Any other set-point: what its mask has (tether/uav/setpoint.h).
struct Setpoint {
  Duration after{0};  ///< of the set-points of a command: from when it arrives
  std::uint64_t mask = 0;
  bool in_heading = false;  ///< velocity and acceleration are in H, else in W
  double p_WB_m[3] = {};
  double velocity_m_s[3] = {};
  double acceleration_m_s2[3] = {};
  double yaw_rad = 0.0;
  double yaw_rate_rad_s = 0.0;
  double q_WB[4] = {1, 0, 0, 0};  ///< w x y z
  double w_WB_B_rad_s[3] = {};
  double thrust_N = 0.0;
  std::vector<double> rotor_speeds_rad_s{};
  std::vector<double> joints_rad{};
  friend bool operator==(const Setpoint&, const Setpoint&) = default;
};

}  // namespace tether::record
