#pragma once

#include <cmath>
#include <numbers>

#include <tether/uav/math.h>

/// Between the frames of MAVLink (the world NED, the body FRD) and Tether's (ENU, FLU; REP-103).
namespace tether::mavlink {

constexpr uav::Vec3 ned_from_enu(const uav::Vec3& v) {
  return {v.y, v.x, -v.z};
}
constexpr uav::Vec3 enu_from_ned(const uav::Vec3& v) {
  return {v.y, v.x, -v.z};
}
constexpr uav::Vec3 frd_from_flu(const uav::Vec3& v) {
  return {v.x, -v.y, -v.z};
}
constexpr uav::Vec3 flu_from_frd(const uav::Vec3& v) {
  return {v.x, -v.y, -v.z};
}

/// The attitude of FRD in NED, of that of FLU in ENU: q_NED_FRD = q_NED_ENU q_ENU_FLU q_FLU_FRD.
/// Both outer rotations are half turns, about (1, 1, 0)/√2 and about x.
inline uav::Quat ned_from_enu(const uav::Quat& q_ENU_FLU) {
  constexpr double kHalf = std::numbers::sqrt2 / 2.0;
  const uav::Quat q = uav::Quat{0.0, kHalf, kHalf, 0.0} * q_ENU_FLU * uav::Quat{0.0, 1.0, 0.0, 0.0};
  return q.w < 0.0 ? uav::Quat{-q.w, -q.x, -q.y, -q.z} : q;
}
/// The inverse, by the same half turns.
inline uav::Quat enu_from_ned(const uav::Quat& q_NED_FRD) {
  return ned_from_enu(q_NED_FRD);
}

/// Yaw clockwise from north, of one counter-clockwise from east; in (−π, π].
inline double ned_from_enu_yaw(double yaw_rad) {
  const double turned = std::remainder(std::numbers::pi / 2.0 - yaw_rad, 2.0 * std::numbers::pi);
  return turned <= -std::numbers::pi ? std::numbers::pi : turned;
}
/// The inverse.
inline double enu_from_ned_yaw(double yaw_rad) {
  return ned_from_enu_yaw(yaw_rad);
}

}  // namespace tether::mavlink
