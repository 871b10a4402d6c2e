#pragma once

#include <tether/uav/math.h>

/// How far things move in a picture, as pure functions: about as many pixels as near its middle, at
/// the edges of a wide picture up to twice that.
namespace tether::sim {

/// Two poses of one frame, a step apart.
struct Movement {
  uav::Pose before;
  uav::Pose after;
};

/// How far the picture moves because the camera does; nothing in it is nearer than `nearest_m`.
double camera_motion_px(const Movement& camera, double nearest_m, double focal_px);

/// How far a body of the given radius about its origin moves in the picture by itself, seen from
/// `p_WS`, no nearer than `near_m`.
double body_motion_px(const Movement& body, double radius_m, const uav::Vec3& p_WS, double near_m,
                      double focal_px);

}  // namespace tether::sim
