#include "image_motion.h"

#include <algorithm>
#include <cmath>

namespace tether::sim {
namespace {

double distance_moved(const Movement& m) {
  return norm(m.after.p - m.before.p);
}

double angle_turned(const Movement& m) {
  const uav::Quat q = inverse(m.before.q) * m.after.q;
  return 2.0 * std::atan2(uav::norm({q.x, q.y, q.z}), std::abs(q.w));
}

}  // namespace

double camera_motion_px(const Movement& camera, double nearest_m, double focal_px) {
  return focal_px * (angle_turned(camera) + distance_moved(camera) / nearest_m);
}

double body_motion_px(const Movement& body, double radius_m, const uav::Vec3& p_WS, double near_m,
                      double focal_px) {
  const double surface_m = distance_moved(body) + angle_turned(body) * radius_m;
  const double nearest_m = std::max(near_m, norm(body.after.p - p_WS) - radius_m);
  return focal_px * surface_m / nearest_m;
}

}  // namespace tether::sim
