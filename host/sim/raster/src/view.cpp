#include <algorithm>
#include <cmath>

#include <tether/sim_raster/view.h>

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

double step_motion_px(const View& view, std::size_t step, std::span<const double> radii_m,
                      double nearest_m) {
  const double focal_px = std::max(view.camera.fx_px, view.camera.fy_px);
  const Instant& from = view.instants[step];
  const Instant& to = view.instants[step + 1];
  double of_bodies = 0.0;
  for (std::size_t i = 0; i < radii_m.size(); ++i) {
    if (view.hidden == i) continue;
    const double surface_m = distance_moved(from.X_WB[i], to.X_WB[i]) +
                             angle_turned(from.X_WB[i], to.X_WB[i]) * radii_m[i];
    const double near_m = std::max(view.near_m, norm(to.X_WB[i].p - to.X_WC.p) - radii_m[i]);
    of_bodies = std::max(of_bodies, surface_m / near_m);
  }
  const double of_camera =
      angle_turned(from.X_WC, to.X_WC) + distance_moved(from.X_WC, to.X_WC) / nearest_m;
  return focal_px * (of_camera + of_bodies);
}

}  // namespace

void interpolate(const View& view, double before_end_s, Moment& moment) {
  const std::size_t last = view.instants.size() - 1;
  const double back = view.spacing_s > 0.0 ? before_end_s / view.spacing_s : 0.0;
  const double at = std::clamp(static_cast<double>(last) - back, 0.0, static_cast<double>(last));
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
  double fastest_px = 0.0;
  for (std::size_t i = 0; i + 1 < view.instants.size(); ++i) {
    fastest_px = std::max(fastest_px, step_motion_px(view, i, body_radii_m, nearest_m));
  }
  return fastest_px > 0.0 ? fastest_px * (view.exposure_s + view.readout_s) / view.spacing_s : 0.0;
}

}  // namespace tether::raster
