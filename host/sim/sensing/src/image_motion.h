#pragma once

#include <tether/uav/math.h>

/// Motion of objects in a picture, as pure functions: the pixels near its middle; at the edges of a
/// wide picture up to twice that.
namespace tether::sim {

/// Two poses of one frame, a step apart.
struct Movement {
  uav::Pose before;
  uav::Pose after;
};

/// Motion of the picture by that of the camera; no object is nearer than `nearest_m`.
double camera_motion_px(const Movement& camera, double nearest_m, double focal_px);

/// Motion in the picture of a body of the given radius about its origin, seen from `p_WS`, no
/// nearer than `near_m`.
double body_motion_px(const Movement& body, double radius_m, const uav::Vec3& p_WS, double near_m,
                      double focal_px);

}  // namespace tether::sim
