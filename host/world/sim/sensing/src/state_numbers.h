#pragma once

#include <cstddef>

#include <tether/uav/math.h>

/// Between our vectors and the numbers of a captured state.
namespace tether::sim {

/// Position, then quaternion as w, x, y, z.
inline constexpr std::size_t kPoseSize = 7;
/// The four vectors of a BodyMotion.
inline constexpr std::size_t kMotionSize = 12;

inline uav::Vec3 read_vec3(const double* in) {
  return {in[0], in[1], in[2]};
}
inline uav::Pose read_pose(const double* in) {
  return {read_vec3(in), {in[3], in[4], in[5], in[6]}};
}

inline double* write(const uav::Vec3& v, double* out) {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
  return out + 3;
}
inline double* write(const uav::Pose& X, double* out) {
  out = write(X.p, out);
  out[0] = X.q.w;
  out[1] = X.q.x;
  out[2] = X.q.y;
  out[3] = X.q.z;
  return out + 4;
}

}  // namespace tether::sim
