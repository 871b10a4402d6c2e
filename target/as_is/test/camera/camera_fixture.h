#pragma once

#include "camera/camera.h"

#include <algorithm>
#include <deque>
#include <optional>

namespace tether::as_is {

inline uav::SensorDescription camera_of(double rate_hz = 30.0) {
  uav::CameraProperties properties;
  properties.model.width_px = 4;
  properties.model.height_px = 2;
  return {"front", {}, rate_hz, properties};
}

inline constexpr std::uint32_t kType = V4L2_BUF_TYPE_VIDEO_CAPTURE;

inline v4l2_requestbuffers buffers_of(std::uint32_t count) {
  v4l2_requestbuffers out{};
  out.count = count;
  out.type = kType;
  out.memory = V4L2_MEMORY_MMAP;
  return out;
}
inline v4l2_buffer buffer_of(std::uint32_t index = 0) {
  v4l2_buffer out{};
  out.index = index;
  out.type = kType;
  out.memory = V4L2_MEMORY_MMAP;
  return out;
}

/// The images of a camera, by their time of arrival: image k is sampled at k periods of 10 ms.
class Arrivals {
 public:
  static constexpr Duration kPeriod = std::chrono::milliseconds(10);

  explicit Arrivals(Duration delay) : delay_(delay) {}

  Camera::Images images() {
    return {.take = [this] { return next(); },
            .drop = [this](bool) { next_ = std::max(next_, arrived()); },
            .now = [this] { return now; }};
  }

  ExecTime now{};

 private:
  std::uint64_t arrived() const {
    const Duration since = now.time_since_epoch() - delay_;
    return since < Duration(0) ? 0 : static_cast<std::uint64_t>(since / kPeriod) + 1;
  }
  std::optional<uav::CameraSample> next() {
    if (next_ >= arrived()) return std::nullopt;
    const std::uint64_t index = next_++;
    uav::CameraSample image;
    image.sampled_at = SimTime(index * kPeriod);
    image.index = index;
    image.width_px = 4;
    image.height_px = 2;
    image.rgb.assign(4 * 2 * 3, static_cast<std::uint8_t>(index));
    return image;
  }

  Duration delay_;
  std::uint64_t next_ = 0;
};

}  // namespace tether::as_is
