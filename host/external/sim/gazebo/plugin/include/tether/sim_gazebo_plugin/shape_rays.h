#pragma once

#include <tether/sim_gazebo_plugin/ray_frames.h>
#include <tether/uav/math.h>

/// The distance along a ray, in the shape's frame, to the surface of a shape around the origin,
/// also from inside; +inf: no hit [m].
namespace tether::gazebo_plugin {

double distance_to_box_m(const Ray& ray, const uav::Vec3& size_m);
double distance_to_sphere_m(const Ray& ray, double radius_m);
/// Along z.
double distance_to_cylinder_m(const Ray& ray, double radius_m, double length_m);

}  // namespace tether::gazebo_plugin
