#pragma once

#include <tether/sim/world.h>

/// What a camera's shutter makes of a picture that changes while it is taken, as pure functions.
/// The picture is known at evenly spaced instants of the window and taken to change linearly in
/// between.
namespace tether::sim {

/// CameraModel's shutter, and the rows that it goes over.
struct Shutter {
  double exposure_s = 0.0;
  double readout_s = 0.0;
  int rows = 1;

  explicit Shutter(const CameraModel& camera);
  /// From the beginning of the first row's exposure to the end of the last row's.
  double window_s() const { return exposure_s + readout_s; }
};

/// The most instants that a picture is mixed of.
constexpr int kMaxInstants = 32;

/// How many instants the picture must be known at when things move by `motion_px` within the
/// window: about a pixel between two. 1 where the motion changes no byte.
int count_instants(double motion_px);

/// How much of row `row`'s light is that of instant `instant` of `instants`, the first at the
/// window's beginning, the last at its end. The weights of a row's instants are not negative and
/// sum to 1.
double row_weight(const Shutter& shutter, int row, int instant, int instants);

}  // namespace tether::sim
