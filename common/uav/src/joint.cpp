#include <algorithm>

#include <tether/uav/setpoint.h>

namespace tether::uav {

double start_rad(const Joint& joint) {
  return std::clamp(0.0, joint.min_rad, joint.max_rad);
}

double turned_rad(const Joint& joint, double angle_rad, double target_rad, double seconds) {
  const double most_rad = joint.max_rate_rad_s * seconds;
  return angle_rad + std::clamp(target_rad - angle_rad, -most_rad, most_rad);
}

// The product of exponentials: the outermost joint turns first.
Pose turned(std::span<const Joint> joints, std::span<const double> angles_rad, const Pose& X_B0) {
  Pose X = X_B0;
  for (std::size_t i = angles_rad.size(); i-- > 0;) {
    const Quat turn = from_axis_angle(joints[i].axis_B, angles_rad[i]);
    X = {joints[i].p_BJ + rotate(turn, X.p - joints[i].p_BJ), turn * X.q};
  }
  return X;
}

}  // namespace tether::uav
