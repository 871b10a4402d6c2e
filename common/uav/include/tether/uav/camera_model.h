#pragma once

#include <optional>

#include <tether/uav/math.h>

namespace tether::uav {

struct Pixel {
  double u_px = 0.0;  ///< right from the centre of the left-most column
  double v_px = 0.0;  ///< down from the centre of the top row
};

/// Pinhole camera with the Brown-Conrady distortion of SDF's <distortion> (k1 k2 k3 radial, p1 p2
/// tangential). Points are in the optical frame C (x right, y down, z forward).
struct CameraModel {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;  ///< principal point; (width−1)/2 for a centred one
  double cy_px = 0.0;
  double k1 = 0.0, k2 = 0.0, k3 = 0.0, p1 = 0.0, p2 = 0.0;

  /// A centred ideal camera with the given horizontal field of view, square pixels.
  static CameraModel from_horizontal_fov(int width_px, int height_px, double horizontal_fov_rad);

  double horizontal_fov_rad() const;
  bool has_distortion() const;

  /// The pixel of a point; none if it is not in front of the camera (z ≤ 0). May be outside the
  /// image.
  std::optional<Pixel> project(const Vec3& p_C) const;
  /// The viewing direction of a pixel, scaled to z = 1. Undoes the distortion iteratively.
  Vec3 unproject(const Pixel& pixel) const;
  bool contains(const Pixel& pixel) const;
  friend bool operator==(const CameraModel&, const CameraModel&) = default;
};

/// The viewing directions of a camera's pixels. A value.
class PixelRays {
 public:
  explicit PixelRays(const CameraModel& camera);

  /// Scaled to z = 1. None where the distortion maps no direction to the pixel: strong barrel
  /// distortion folds back on itself before it reaches the corners.
  std::optional<Vec3> at(const Pixel& pixel) const;

 private:
  CameraModel camera_;
  double fold_radius_;
};

/// Horizontal bearing of a pixel: angle of its viewing direction about the body's z,
/// counter-clockwise (left of the centre is positive) [rad].
double bearing_rad(const CameraModel& model, const Pixel& pixel);

}  // namespace tether::uav
