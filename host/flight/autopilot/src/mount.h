#pragma once

#include <span>
#include <vector>

#include <tether/uav/joint.h>

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

}  // namespace tether::autopilot
