#pragma once

#include "command.h"

#include <span>
#include <utility>
#include <vector>

#include <tether/uav/setpoint.h>

/// A gimbal by the angles that MAVLink has for it.
namespace tether::autopilot {

/// Against the body [deg]: the camera's nose up, its right side down, its nose to the right. NaN:
/// that axis keeps its angle.
struct MountAngles {
  double pitch_deg, roll_deg, yaw_deg;
};

/// Sets the angles of the joints that turn about these axes, each within its limits: a joint turns
/// about the axis of the body that is nearest to its own. False: no joint turns about any axis for
/// which there is an angle.
/// @pre as many angles as joints
bool point(std::span<const uav::Joint> joints, const MountAngles& wanted,
           std::vector<double>& angles_rad);

// MAV_CMD.
inline constexpr int kDoMountControl = 205, kDoGimbalPitchYaw = 1000;

/// The joints of a UAV, by MAVLink's commands for gimbals.
class Mount {
 public:
  Mount() = default;
  explicit Mount(std::vector<uav::Joint> joints) : joints_(std::move(joints)) {}

  /// Whether it turns by such commands.
  bool takes(const Command& command) const {
    return !joints_.empty() && (command.id == kDoMountControl || command.id == kDoGimbalPitchYaw);
  }
  /// Its MAV_RESULT. @pre takes(command)
  int run(const Command& command);
  /// Once it was pointed: the set-point with its angles.
  void add_to(uav::Setpoint& setpoint) const;

 private:
  std::vector<uav::Joint> joints_;
  std::vector<double> angles_rad_;  // to which they were commanded; empty: they were not
};

}  // namespace tether::autopilot
