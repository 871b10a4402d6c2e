#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <tether/uav/camera_model.h>

namespace tether::sim {

/// Makes the image of a camera with lens distortion or oblong pixels from that of an ideal camera
/// with square pixels, as renderers draw. Finds each pixel's viewing direction in the ideal image
/// (bilinear). A pixel to which the distortion maps no direction is black:
/// strong barrel distortion folds back on itself before it reaches the corners.
class ImageWarp {
 public:
  /// Whether `camera` needs it.
  static bool is_needed(const uav::CameraModel& camera);

  explicit ImageWarp(const uav::CameraModel& camera);

  /// The ideal camera to render: wide enough for every pixel, at most 4096 pixels each way.
  const uav::CameraModel& source() const { return source_; }
  /// `ideal_rgb` is the picture of `source()`, `rgb` that of the camera given at construction:
  /// height × width × 3 bytes each, rows from the top down.
  void apply(std::span<const std::uint8_t> ideal_rgb, std::span<std::uint8_t> rgb) const;
  /// How many pixels have no viewing direction.
  std::size_t blind_pixels() const { return blind_pixels_; }

 private:
  /// For each pixel, row by row, where it is in the ideal image; negative: nowhere.
  std::vector<uav::Pixel> lookup_;
  std::size_t blind_pixels_ = 0;
  uav::CameraModel source_;
};

}  // namespace tether::sim
