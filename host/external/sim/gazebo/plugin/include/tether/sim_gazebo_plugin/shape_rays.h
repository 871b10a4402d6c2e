#pragma once

#include <tether/uav/math.h>

namespace tether::gazebo_plugin {

/// A ray in W: `direction` has unit length.
struct Ray {
  uav::Vec3 origin;
  uav::Vec3 direction;
};

/// The ray, in W, of a sensor's direction in its own frame.
inline Ray ray_in_world(const uav::Pose& X_WS, const uav::Vec3& direction_S) {
  return {X_WS.p, rotate(X_WS.q, direction_S)};
}

/// The ray that hits a body at its current pose as `ray` hits it at its given pose, so that the
/// body need not be moved.
inline Ray ray_to_body_now(const Ray& ray, const uav::Pose& X_WB_given, const uav::Pose& X_WB_now) {
  const uav::Pose X = X_WB_now * inverse(X_WB_given);
  return {transform(X, ray.origin), rotate(X.q, ray.direction)};
}

// The distance along a ray, in the shape's frame, to the surface of a shape around the origin,
// also from inside; +inf: no hit [m].

double distance_to_box_m(const Ray& ray, const uav::Vec3& size_m);
double distance_to_sphere_m(const Ray& ray, double radius_m);
/// Along z.
double distance_to_cylinder_m(const Ray& ray, double radius_m, double length_m);

}  // namespace tether::gazebo_plugin
