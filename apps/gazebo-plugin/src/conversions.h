#pragma once

#include <ignition/math/Pose3.hh>
#include <ignition/math/Quaternion.hh>
#include <ignition/math/Vector3.hh>

#include <tether/uav/math.h>

/// Between our vectors and Gazebo's: both metres, quaternions as (w, x, y, z).
namespace tether::gazebo_plugin {

inline uav::Vec3 from_gazebo(const ignition::math::Vector3d& v) {
  return {v.X(), v.Y(), v.Z()};
}
inline ignition::math::Pose3d to_gazebo(const uav::Pose& X) {
  return {X.p.x, X.p.y, X.p.z, X.q.w, X.q.x, X.q.y, X.q.z};
}

}  // namespace tether::gazebo_plugin
