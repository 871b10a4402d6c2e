#include "exposure.h"

#include <algorithm>
#include <cmath>

namespace tether::raster {
namespace {

using uav::Pose;
using uav::Quat;
using uav::Vec3;

// A motion of this much changes the sharpest edge from black to white by half a grey level.
constexpr double kStill_px = 1.0 / 512.0;
constexpr int kMaxLayers = 16;
constexpr int kMaxBands = 128;
constexpr int kMinBandRows = 4;
constexpr double kBand_px = 0.5;

Pose between(const Pose& a, const Pose& b, double share) {
  const double same = a.q.w * b.q.w + a.q.x * b.q.x + a.q.y * b.q.y + a.q.z * b.q.z;
  const double sign = same < 0.0 ? -1.0 : 1.0;
  const auto mix = [&](double from, double to) { return from + share * (sign * to - from); };
  return {a.p + share * (b.p - a.p), uav::normalized({mix(a.q.w, b.q.w), mix(a.q.x, b.q.x),
                                                      mix(a.q.y, b.q.y), mix(a.q.z, b.q.z)})};
}

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

int parts(double motion_px, double each_px, int most) {
  return static_cast<int>(std::ceil(std::min(motion_px / each_px, static_cast<double>(most))));
}

}  // namespace

void interpolate(std::span<const Instant> instants, double share, Moment& moment) {
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(instants.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, instants.size() - 1);
  const double rest = at - static_cast<double>(low);
  const Instant& a = instants[low];
  const Instant& b = instants[high];
  moment.X_WC = between(a.X_WC, b.X_WC, rest);
  moment.X_WB.resize(a.X_WB.size());
  for (std::size_t i = 0; i < a.X_WB.size(); ++i) {
    moment.X_WB[i] = between(a.X_WB[i], b.X_WB[i], rest);
  }
}

double motion_px(const View& view, std::span<const double> body_radii_m, double nearest_m) {
  double fastest = 0.0;
  for (std::size_t i = 0; i + 1 < view.instants.size(); ++i) {
    fastest = std::max(fastest, step_motion_px(view, i, body_radii_m, nearest_m));
  }
  return fastest * static_cast<double>(view.instants.size() - 1);
}

Sampling choose_sampling(const View& view, double motion_px) {
  Sampling sampling;
  const double window_s = view.exposure_s + view.readout_s;
  if (window_s <= 0.0) return sampling;
  const double exposed_px = motion_px * view.exposure_s / window_s;
  const double rolled_px = motion_px * view.readout_s / window_s;
  if (exposed_px > kStill_px) {
    sampling.layers = std::max(2, parts(exposed_px, 1.0, kMaxLayers));
  }
  if (rolled_px > kStill_px) {
    const int most = std::clamp(view.camera.height_px / kMinBandRows, 1, kMaxBands);
    sampling.bands = std::max(1, parts(rolled_px, kBand_px, most));
  }
  return sampling;
}

double share_of(const View& view, double row, int layer, int layers) {
  const double window_s = view.exposure_s + view.readout_s;
  if (window_s <= 0.0) return 1.0;
  const int rows = view.camera.height_px;
  const double late_s = rows == 1 ? 0.0 : view.readout_s * (rows - 1 - row) / (rows - 1);
  const double before_end_s = late_s + view.exposure_s * (1.0 - (layer + 0.5) / layers);
  return 1.0 - before_end_s / window_s;
}

}  // namespace tether::raster
