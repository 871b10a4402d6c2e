#include "exposure.h"

#include <algorithm>
#include <cmath>

namespace tether::raster {
namespace {

// A motion of this much changes the sharpest edge from black to white by half a grey level.
constexpr double kStill_px = 1.0 / 512.0;
constexpr int kMaxLayers = 16;
constexpr int kMaxBands = 128;
constexpr int kMinBandRows = 4;
constexpr double kBand_px = 0.5;

int parts(double motion_px, double each_px, int most) {
  return static_cast<int>(std::ceil(std::min(motion_px / each_px, static_cast<double>(most))));
}

}  // namespace

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

double before_end_s(const View& view, double row, int layer, int layers) {
  const int rows = view.camera.height_px;
  const double late_s = rows == 1 ? 0.0 : view.readout_s * (rows - 1 - row) / (rows - 1);
  return late_s + view.exposure_s * (1.0 - (layer + 0.5) / layers);
}

}  // namespace tether::raster
