#include "shutter.h"

#include <algorithm>
#include <cmath>

namespace tether::sim {
namespace {

// A motion of this much changes the sharpest edge from black to white by half a grey level.
constexpr double kStill_px = 1.0 / 512.0;
// Below this part of an instant's distance, an exposure is an instant: its mean would be a
// difference of nearly equal numbers.
constexpr double kShort = 1e-6;

// The share of an instant at distance `x`, in instants.
double hat(double x) {
  return std::max(0.0, 1.0 - std::abs(x));
}

// The integral of `hat` up to x.
double hat_integral(double x) {
  if (x <= -1.0) return 0.0;
  if (x >= 1.0) return 1.0;
  return x < 0.0 ? 0.5 * (1.0 + x) * (1.0 + x) : 1.0 - 0.5 * (1.0 - x) * (1.0 - x);
}

}  // namespace

int count_instants(double motion_px) {
  if (!(motion_px > kStill_px)) return 1;
  return 1 + static_cast<int>(std::ceil(std::min(motion_px, kMaxInstants - 1.0)));
}

double row_weight(const raster::View& view, int row, int instant, int instants) {
  if (instants == 1) return 1.0;
  const double last = instants - 1;
  const double per_s = last / window_s(view);
  const int rows_after = view.camera.height_px - 1 - row;
  const double late_s =
      rows_after == 0 ? 0.0 : view.readout_s * rows_after / (view.camera.height_px - 1);
  const double end = last - late_s * per_s;
  const double begin = std::max(0.0, end - view.exposure_s * per_s);
  if (end - begin < kShort) return hat(end - instant);
  return (hat_integral(end - instant) - hat_integral(begin - instant)) / (end - begin);
}

}  // namespace tether::sim
