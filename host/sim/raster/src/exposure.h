#pragma once

#include <tether/sim_raster/view.h>

/// How a picture is put together that changes while it is taken.
namespace tether::raster {

/// How finely time is divided.
struct Sampling {
  int layers = 1;  ///< moments in each row's exposure
  int bands = 1;   ///< parts of the picture's rows, each read out at one time

  friend bool operator==(const Sampling&, const Sampling&) = default;
};

/// At most a pixel of motion between two layers, half of one between two bands.
Sampling choose_sampling(const View& view, double motion_px);

/// How long before the end of the view layer `layer` of some rows is [s]. The layers are the
/// middles of equal parts of the exposure.
double before_end_s(const View& view, double row, int layer, int layers);

}  // namespace tether::raster
