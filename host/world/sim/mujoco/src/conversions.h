#pragma once

#include <mujoco/mujoco.h>

#include <tether/uav/math.h>

/// Between our vectors and MuJoCo's arrays: both metres, W axes, quaternions as (w, x, y, z).
namespace tether::sim {

inline uav::Vec3 vec3_from(const mjtNum* a) {
  return {a[0], a[1], a[2]};
}
inline uav::Quat quat_from(const mjtNum* a) {
  return {a[0], a[1], a[2], a[3]};
}
/// A free joint's configuration: position, then quaternion.
inline uav::Pose pose_from(const mjtNum* qpos) {
  return {vec3_from(qpos), quat_from(qpos + 3)};
}

template <class T>
void copy_to(const uav::Vec3& v, T* out) {
  out[0] = static_cast<T>(v.x);
  out[1] = static_cast<T>(v.y);
  out[2] = static_cast<T>(v.z);
}
inline void copy_to(const uav::Pose& X, mjtNum* qpos) {
  copy_to(X.p, qpos);
  qpos[3] = X.q.w;
  qpos[4] = X.q.x;
  qpos[5] = X.q.y;
  qpos[6] = X.q.z;
}

}  // namespace tether::sim
