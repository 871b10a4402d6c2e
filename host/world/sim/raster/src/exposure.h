#pragma once

#include "place/layer.h"
#include "place/lens.h"
#include "place/rasterize.h"

#include <cstdint>
#include <span>
#include <vector>

#include <tether/sim_raster/renderer.h>

/// How a picture is put together that changes while it is taken.
namespace tether::raster {

/// How finely time is divided.
///
/// Each tile has as many layers as its own motion asks for: 1, 3, 9 or 27, in the middles of equal
/// parts of the exposure. So the layers of fewer are among those of more.
class Sampling {
 public:
  /// Nothing moves.
  Sampling() = default;
  /// At most a pixel of motion between two layers, half of one between two bands. `middle`: the
  /// whole picture in the middle of the view's time.
  Sampling(const View& view, const Lens& lens, std::span<const double> body_radii_m,
           const Layer& middle);

  /// So many rows are read out at once: all, a number of tiles, or a part of a tile. 0: all.
  int band_rows() const { return band_rows_; }
  /// How far things move in a part of the picture during a row's exposure, at most [px].
  double exposed_px(const Tile& tile) const;
  int layers(const Tile& tile) const;
  /// Of the tile that has most.
  int most_layers() const;

 private:
  int across_ = 0;
  std::vector<float> exposed_px_;  // of tiles, from the upper left corner on; empty: nothing moves
  int band_rows_ = 0;
};

/// How long before the end of the view a layer of some rows is [s].
double before_end_s(const View& view, double row, int layer, int layers);

}  // namespace tether::raster
