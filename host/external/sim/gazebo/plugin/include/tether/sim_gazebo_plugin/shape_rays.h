#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

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

struct BoxVertex {
  uav::Vec3 position;  ///< of a box with edges of length 1 around the origin
  uav::Vec3 normal;
  double u = 0.0, v = 0.0;
};

struct BoxMesh {
  std::vector<BoxVertex> vertices;
  /// Counter-clockwise, seen from outside.
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A unit box to be scaled to `size_m`. Its texture begins in the upper left corner of each face,
/// seen from outside (top and bottom: at the ends of −x and of +y), with the given repetitions per
/// metre.
BoxMesh textured_box(const uav::Vec3& size_m, double repeat_x_per_m, double repeat_y_per_m);

struct TextureRepeat {
  double x = 1.0, y = 1.0;
};

/// The repetitions of a texture over one of Gazebo's unit shapes that is scaled to `size_m`, for
/// the given repetitions per metre of surface. 1 for any other mesh, which has its own coordinates.
TextureRepeat texture_repeat(const std::string& mesh, const uav::Vec3& size_m,
                             double repeat_x_per_m, double repeat_y_per_m);

}  // namespace tether::gazebo_plugin
