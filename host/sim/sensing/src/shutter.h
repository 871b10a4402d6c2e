#pragma once

#include <tether/sim/world.h>

/// The effect of a camera's shutter on a changing picture, as pure functions. The picture is known
/// at evenly spaced instants of the window and is assumed to change linearly in between.
namespace tether::sim {

/// CameraModel's shutter, and the rows of its image.
struct Shutter {
  double exposure_s = 0.0;
  double readout_s = 0.0;
  int rows = 1;

  explicit Shutter(const CameraModel& camera);
  /// From the beginning of the first row's exposure to the end of the last row's.
  double window_s() const { return exposure_s + readout_s; }
};

/// Maximum number of instants that are mixed into an image.
constexpr int kMaxInstants = 32;

/// Number of instants for objects that move by `motion_px` within the window: about a pixel between
/// two. 1 if the motion changes no byte.
int count_instants(double motion_px);

/// The fraction of row `row`'s light from instant `instant` of `instants`, the first at the
/// window's beginning, the last at its end. The weights of a row's instants are not negative and
/// sum to 1.
double row_weight(const Shutter& shutter, int row, int instant, int instants);

}  // namespace tether::sim
