#pragma once

#include "image.h"

#include <cstdint>
#include <span>
#include <vector>

#include <tether/uav/camera_model.h>

namespace tether::sim {

/// Makes the image of a camera with lens distortion or oblong pixels out of one of an ideal camera
/// with square pixels, which is all that the renderer draws. Looks each pixel's viewing direction
/// up in the ideal image (bilinear).
class ImageWarp {
 public:
  /// Whether `camera` needs it.
  static bool is_needed(const uav::CameraModel& camera);

  explicit ImageWarp(const uav::CameraModel& camera);

  /// The ideal camera to render: wide enough for every pixel, at most 4096 pixels each way.
  const uav::CameraModel& source() const { return source_; }
  /// `rgb` holds height × width × 3 bytes of the camera given at construction.
  void apply(const RawImage& source, std::span<std::uint8_t> rgb) const;

 private:
  std::vector<uav::Pixel> lookup_;  ///< for each pixel, row by row: where it is in the ideal image
  uav::CameraModel source_;
};

}  // namespace tether::sim
