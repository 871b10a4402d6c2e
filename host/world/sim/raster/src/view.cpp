#include <algorithm>
#include <cmath>

#include <tether/sim_raster/renderer.h>

namespace tether::raster {
namespace {

using uav::Pose;
using uav::Quat;
using uav::Vec3;

double distance_moved(const Pose& a, const Pose& b) {
  return norm(b.p - a.p);
}

// A little less than the angle, if it is small.
double angle_turned(const Pose& a, const Pose& b) {
  const Quat q = inverse(a.q) * b.q;
  return 2.0 * norm(Vec3{q.x, q.y, q.z});
}

double focal_px(const View& view) {
  return std::max(view.camera.fx_px, view.camera.fy_px);
}

// The most of what `of_step` gives for two instants that follow each other, throughout the window.
template <class OfStep>
double throughout(const View& view, const OfStep& of_step) {
  double most = 0.0;
  for (std::size_t i = 0; i + 1 < view.instants.size(); ++i) {
    most = std::max(most, of_step(view.instants[i], view.instants[i + 1]));
  }
  return most > 0.0 ? most * (view.exposure_s + view.readout_s) / view.spacing_s : 0.0;
}

}  // namespace

double place_among_instants(const View& view, double before_end_s) {
  const auto last = static_cast<double>(view.instants.size() - 1);
  const double back = view.spacing_s > 0.0 ? before_end_s / view.spacing_s : 0.0;
  return std::clamp(last - back, 0.0, last);
}

void interpolate(const View& view, double before_end_s, Moment& moment) {
  const std::size_t last = view.instants.size() - 1;
  const double at = place_among_instants(view, before_end_s);
  const auto low = static_cast<std::size_t>(at);
  const double share = at - static_cast<double>(low);
  const Instant& a = view.instants[low];
  const Instant& b = view.instants[std::min(low + 1, last)];
  moment.X_WC = uav::between(a.X_WC, b.X_WC, share);
  moment.X_WB.resize(a.X_WB.size());
  for (std::size_t i = 0; i < a.X_WB.size(); ++i) {
    moment.X_WB[i] = uav::between(a.X_WB[i], b.X_WB[i], share);
  }
}

double motion_px(const View& view, std::span<const double> body_radii_m, double nearest_m) {
  double of_bodies = 0.0;
  for (std::size_t i = 0; i < body_radii_m.size(); ++i) {
    of_bodies = std::max(of_bodies, body_motion_px(view, i, body_radii_m[i]));
  }
  return of_bodies + throughout(view, [&](const Instant& from, const Instant& to) {
           return focal_px(view) * (angle_turned(from.X_WC, to.X_WC) +
                                    distance_moved(from.X_WC, to.X_WC) / nearest_m);
         });
}

double body_motion_px(const View& view, std::size_t body, double radius_m) {
  if (view.hidden == body) return 0.0;
  return throughout(view, [&](const Instant& from, const Instant& to) {
    const Pose& before = from.X_WB[body];
    const Pose& after = to.X_WB[body];
    const double moved_m = distance_moved(before, after) + angle_turned(before, after) * radius_m;
    return focal_px(view) * moved_m / std::max(view.near_m, norm(after.p - to.X_WC.p) - radius_m);
  });
}

}  // namespace tether::raster
