#pragma once

#include <tether/sim_raster/renderer.h>

/// The effect of a view's shutter on a changing picture, as pure functions. The picture is known at
/// evenly spaced instants of the window, from the beginning of the first row's exposure to the end
/// of the last row's, and is assumed to change linearly in between.
namespace tether::sim {

inline double window_s(const raster::View& view) {
  return view.exposure_s + view.readout_s;
}

/// Maximum number of instants that are mixed into an image.
constexpr int kMaxInstants = 32;

/// Number of instants for objects that move by `motion_px` within the window: about a pixel between
/// two. 1 if the motion changes no byte.
int count_instants(double motion_px);

/// The fraction of row `row`'s light from instant `instant` of `instants`, the first at the
/// window's beginning, the last at its end. The weights of a row's instants are not negative and
/// sum to 1.
double row_weight(const raster::View& view, int row, int instant, int instants);

}  // namespace tether::sim
