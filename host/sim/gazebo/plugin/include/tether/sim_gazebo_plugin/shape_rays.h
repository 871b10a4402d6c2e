#pragma once

#include <tether/sim_gazebo_plugin/ray_frames.h>
#include <tether/uav/math.h>

/// How far along a ray, in the shape's own frame, a shape around the origin is met: its surface,
/// also from inside. +inf where it is not [m].
namespace tether::gazebo_plugin {

double distance_to_box_m(const Ray& ray, const uav::Vec3& size_m);
double distance_to_sphere_m(const Ray& ray, double radius_m);
/// Along z.
double distance_to_cylinder_m(const Ray& ray, double radius_m, double length_m);

}  // namespace tether::gazebo_plugin
