#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tether/sim/world.h>
#include <tether/sim_sensing/sensor_suite.h>
#include <tether/uav/camera_model.h>
#include <tether/uav/math.h>

namespace tether::sim {

/// What to draw: the world with its moving bodies at given poses, as seen by an ideal camera.
struct View {
  /// A pinhole without distortion and with square pixels (fx = fy). The principal point may be
  /// anywhere, outside of the image as well, and the size may change from view to view.
  uav::CameraModel camera;
  double near_m = 0.05;  ///< nothing nearer or farther is drawn, along the camera's axis
  double far_m = 100.0;
  uav::Pose X_WS;                     ///< of the camera: x ahead, y left, z up
  std::span<const uav::Pose> X_WB;    ///< of each of `moving_bodies`, in its order
  std::optional<std::size_t> hidden;  ///< one of `moving_bodies` that is not drawn
  /// Whether `nearest_depth_m()` will be called.
  bool with_depth = false;
};

/// Draws views of the world: what an external simulator provides for cameras; lens and shutter are
/// put together from several (`make_composite_renderer`). The same view always gives the same
/// bytes. One thread at a time.
class ViewRenderer {
 public:
  virtual ~ViewRenderer() = default;
  ViewRenderer(const ViewRenderer&) = delete;
  ViewRenderer& operator=(const ViewRenderer&) = delete;

  /// `rgb` holds height × width × 3 bytes: rows from the top down, pixels R, G, B in sRGB.
  /// @throws Error(kSetup) when the back end is lost.
  virtual void render(const View& view, std::span<std::uint8_t> rgb) = 0;

  /// A lower bound of the distance to the nearest object in the last picture, along the camera's
  /// axis, between the near and the far plane [m]. It decides how many pictures are mixed for a
  /// moving camera. @pre the last view was `with_depth`.
  virtual double nearest_depth_m() = 0;

  /// The renderer's name, for the record: "software renderer".
  virtual std::string name() const = 0;

 protected:
  ViewRenderer() = default;
};

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
