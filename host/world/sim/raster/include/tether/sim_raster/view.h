#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <tether/uav/camera_model.h>
#include <tether/uav/math.h>

/// What a picture is to show, and where it goes. Pure functions of values; safe from any thread.
namespace tether::raster {

/// Where everything is at one moment.
struct Instant {
  uav::Pose X_WC;                   ///< the camera's optical frame
  std::span<const uav::Pose> X_WB;  ///< one for each of Scene::bodies()
};

/// The camera and the moments of a picture.
///
/// Row r of H gathers light during [e − exposure_s, e] with e = end − readout_s·(H−1−r)/(H−1). The
/// last instant is that end; the others are each spacing_s before the next, and the first is not
/// after the beginning, except that a single instant is one at which everything rests. Poses in
/// between are interpolated. Light is averaged as light, not as sRGB bytes.
struct View {
  uav::CameraModel camera;
  double near_m = 0.05;  ///< nothing nearer or farther is drawn, along the camera's axis
  double far_m = 100.0;
  std::span<const Instant> instants;
  double spacing_s = 0.0;
  double exposure_s = 0.0;
  double readout_s = 0.0;
  std::optional<std::size_t> hidden;  ///< a body that is not drawn
  /// Computes the coverage of edges from four samples in each pixel. A surface is still shaded
  /// once in each pixel.
  bool antialias = false;
};

/// The arrays that a picture is written to: height × width entries, rows from the top down. An
/// empty array is not written.
/// Depth and entities are of opaque surfaces, in the middle of each row's exposure.
struct Picture {
  std::span<std::uint8_t> rgb;  ///< three bytes for each pixel
  /// Along the camera's axis [m]. As in REP 117 and 118: +∞ where nothing is within
  /// `depth_max_m` and View::far_m, −∞ where something is between View::near_m and `depth_min_m`,
  /// NaN where the lens sees nothing.
  std::span<float> depth_m;
  std::span<std::uint32_t> entity;  ///< Instance::entity; 0: background
  float depth_min_m = 0.0F;
  float depth_max_m = 1e9F;
};

/// Where everything is at one time of a view.
struct Moment {
  uav::Pose X_WC;
  std::vector<uav::Pose> X_WB;
};

/// Where among the instants, counted from 0, so long before the end of the view is; before the
/// first one, or after the last: there.
double place_among_instants(const View& view, double before_end_s);

/// So long before the end of the view; outside of its instants, at the first or the last.
void interpolate(const View& view, double before_end_s, Moment& moment);

/// How far things move in the picture from the beginning of the first row's exposure to the end of
/// the last row's, near its middle, were they as fast throughout as between the two instants that
/// differ most. At the edges of a wide picture it is up to twice that. No body reaches farther from
/// its origin than its radius, and nothing seen is nearer than `nearest_m`.
double motion_px(const View& view, std::span<const double> body_radii_m, double nearest_m);

/// The same for the surface of one body alone, seen by a camera at rest.
double body_motion_px(const View& view, std::size_t body, double radius_m);

}  // namespace tether::raster
