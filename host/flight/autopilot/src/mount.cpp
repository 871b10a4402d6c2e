#include "mount.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

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

int Mount::run(const Command& command) {
  using command_result::kAccepted;
  using command_result::kDenied;
  using command_result::kUnsupported;
  const auto& p = command.p;
  constexpr double kKeep = std::numeric_limits<double>::quiet_NaN();
  MountAngles wanted{p[1], p[2], p[3]};
  if (command.id == kDoMountControl) {
    constexpr double kByAngles = 2.0;  // MAV_MOUNT_MODE_MAVLINK_TARGETING
    if (p[7] != kByAngles) return kUnsupported;
  } else {
    const bool is_by_rates = std::isfinite(p[3]) || std::isfinite(p[4]);
    constexpr std::int64_t kLocks = 4 + 8 + 16;  // roll, pitch, yaw: against the world
    const std::int64_t flags = whole(p[5]);
    if (is_by_rates || (flags > 0 && (flags & kLocks) != 0)) return kUnsupported;
    wanted = {p[1], kKeep, p[2]};
  }
  std::vector<double> angles_rad = angles_rad_;
  if (angles_rad.empty())
    for (const uav::Joint& joint : joints_) angles_rad.push_back(start_rad(joint));
  if (!point(joints_, wanted, angles_rad)) return kDenied;
  angles_rad_ = std::move(angles_rad);
  return kAccepted;
}

void Mount::add_to(uav::Setpoint& setpoint) const {
  if (angles_rad_.empty()) return;
  setpoint.mask |= uav::kJoints;
  setpoint.joints_rad = angles_rad_;
}

}  // namespace tether::autopilot
