#include "mount.h"

#include <algorithm>
#include <cmath>

#include <tether/base/units.h>

namespace tether::autopilot {
namespace {

/// About the joint's own axis: the body's axes are forward, left and up, MAVLink's forward, right
/// and down.
double angle_deg(const uav::Vec3& axis_B, const MountAngles& wanted) {
  const double x = std::abs(axis_B.x), y = std::abs(axis_B.y), z = std::abs(axis_B.z);
  if (x >= std::max(y, z)) return std::copysign(1.0, axis_B.x) * wanted.roll_deg;
  if (y >= z) return -std::copysign(1.0, axis_B.y) * wanted.pitch_deg;
  return -std::copysign(1.0, axis_B.z) * wanted.yaw_deg;
}

}  // namespace

bool point(std::span<const uav::Joint> joints, const MountAngles& wanted,
           std::vector<double>& angles_rad) {
  bool has_turned = false;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const double angle = angle_deg(joints[i].axis_B, wanted);
    if (!std::isfinite(angle)) continue;
    angles_rad[i] = std::clamp(rad_from_deg(angle), joints[i].min_rad, joints[i].max_rad);
    has_turned = true;
  }
  return has_turned;
}

}  // namespace tether::autopilot
