#pragma once

#include <string>

#include <tether/uav/samples.h>

namespace tether::devices {

/// The image format of a camera.
struct ImageFormat {
  int width_px = 0;
  int height_px = 0;
  double rate_hz = 0.0;  ///< 0: unknown
};

/// Images in their order, as a video library gives them. Throws nothing.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  virtual ImageFormat format() const = 0;
  /// Takes the next image, and waits for it where the source is live, for a bounded time. False:
  /// there is none.
  virtual bool grab() = 0;
  /// Width, height and pixels of the image that was grabbed last; any number of times. False: it
  /// cannot be used. @pre grab() gave true
  virtual bool retrieve(uav::CameraSample& into) = 0;
  /// Of the image that was grabbed last: Video4Linux's timestamp [ms on CLOCK_MONOTONIC], or the
  /// position in a file.
  virtual double position_ms() const = 0;
};

}  // namespace tether::devices
