#include <tether/uav/math.h>

namespace tether::uav {

Quat from_axis_angle(const Vec3& axis, double angle_rad) {
  const Vec3 v = std::sin(0.5 * angle_rad) * axis;
  return {std::cos(0.5 * angle_rad), v.x, v.y, v.z};
}

Quat from_rpy(double roll_rad, double pitch_rad, double yaw_rad) {
  return from_axis_angle({0, 0, 1}, yaw_rad) * from_axis_angle({0, 1, 0}, pitch_rad) *
         from_axis_angle({1, 0, 0}, roll_rad);
}

double yaw_rad(const Quat& q_WB) {
  const Vec3 ahead_W = rotate(q_WB, {1, 0, 0});
  // A −0 in y would give −π, which is outside the half-open interval.
  return std::atan2(ahead_W.y + 0.0, ahead_W.x);
}

Quat normalized(const Quat& q) {
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w / length, q.x / length, q.y / length, q.z / length};
}

Pose between(const Pose& a, const Pose& b, double share) {
  // A quaternion and its opposite are the same rotation.
  const double same = a.q.w * b.q.w + a.q.x * b.q.x + a.q.y * b.q.y + a.q.z * b.q.z;
  const double sign = same < 0.0 ? -1.0 : 1.0;
  const auto mix = [&](double from, double to) { return from + share * (sign * to - from); };
  return {a.p + share * (b.p - a.p),
          normalized({mix(a.q.w, b.q.w), mix(a.q.x, b.q.x), mix(a.q.y, b.q.y), mix(a.q.z, b.q.z)})};
}

}  // namespace tether::uav
