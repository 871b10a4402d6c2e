#pragma once

#include <span>
#include <vector>

#include <tether/sim_raster/renderer.h>

/// How a picture is put together that changes while it is taken.
namespace tether::raster {

/// Where everything is at one moment of a view's window.
struct Moment {
  uav::Pose X_WC;
  std::vector<uav::Pose> X_WB;
};

/// At `share` of the window, 0 its beginning and 1 its end: between the two nearest instants.
void interpolate(std::span<const Instant> instants, double share, Moment& moment);

/// How far things move in the picture within the window, near its middle, were they as fast
/// throughout as between the two instants that differ most. Nothing seen is nearer than
/// `nearest_m`.
double motion_px(const View& view, std::span<const double> body_radii_m, double nearest_m);

/// How finely time is divided.
struct Sampling {
  int layers = 1;  ///< moments in each row's exposure
  int bands = 1;   ///< parts of the picture's rows, each read out at one time

  friend bool operator==(const Sampling&, const Sampling&) = default;
};

/// At most a pixel of motion between two layers, half of one between two bands.
Sampling choose_sampling(const View& view, double motion_px);

/// The share of the window at which layer `layer` of some rows is. The layers are the middles of
/// equal parts of the exposure.
double share_of(const View& view, double row, int layer, int layers);

}  // namespace tether::raster
