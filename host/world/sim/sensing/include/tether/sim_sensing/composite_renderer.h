#pragma once

#include <memory>
#include <vector>

#include <tether/sim/world.h>
#include <tether/sim_sensing/camera_renderer.h>
#include <tether/sim_sensing/view_renderer.h>

namespace tether::sim {

/// A renderer for simulators that draw ideal views only. It resamples a view for the lens, and
/// mixes as many instants of the shutter as the motion in the picture needs, in linear light.
/// Draws colours: of a picture's arrays, only `rgb`.
///
/// `body_radii_m`: an upper bound of the drawn extent of each of `moving_bodies` from its origin.
std::unique_ptr<CameraRenderer> make_composite_renderer(std::unique_ptr<ViewRenderer> views,
                                                        std::vector<double> body_radii_m);

/// The largest views that such a renderer draws for the world's cameras.
struct ViewSize {
  int width_px = 0;  ///< 0: no camera
  int height_px = 0;
};
ViewSize largest_view(const World& world);

}  // namespace tether::sim
