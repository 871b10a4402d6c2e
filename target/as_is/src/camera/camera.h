#pragma once

#include "camera/pixels.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <linux/videodev2.h>

#include <tether/base/time.h>
#include <tether/uav/catalogue.h>
#include <tether/uav/samples.h>

namespace tether::as_is {

/// A camera of the UAV, as its driver answers by V4L2 with buffers that are mapped. It has one size
/// and one rate.
///
/// An image goes into the buffer that was queued first. Images that arrive while no buffer is
/// queued are lost, and `sequence` goes on over them. What has arrived is only looked at when the
/// program asks, with the same outcome: buffers are queued by the program.
///
/// Not thread-safe.
class Camera {
 public:
  /// Where the images come from.
  struct Images {
    /// The oldest one that has arrived and was not taken. None: there is none.
    std::function<std::optional<uav::CameraSample>()> take;
    /// What has arrived is lost. What arrives later waits, if it is to be kept.
    std::function<void(bool keeps_later_ones)> drop;
    std::function<ExecTime()> now;
  };
  /// One of those that have opened it. `signal`: an eventfd, which can be read as often as buffers
  /// are filled.
  struct Opener {
    int signal = -1;
  };

  /// @pre the sensor is a periodic camera with colour
  Camera(const uav::SensorDescription& sensor, unsigned number, Images images);
  ~Camera();
  Camera(const Camera&) = delete;
  Camera& operator=(const Camera&) = delete;

  const std::string& sensor() const { return sensor_; }
  /// An ioctl of an opener: 0 or the error. EAGAIN: no buffer is filled.
  int answer(const Opener& by, unsigned long request, void* argument);
  void close(const Opener& by);

  bool is_streaming() const { return is_streaming_; }
  /// Whether images are compressed for the program, as the camera's own hardware would.
  bool is_compressing() const { return is_streaming_ && format_->is_compressed(); }
  /// Whether an image that arrives now is taken.
  bool has_room() const { return is_streaming_ && !queued_.empty(); }
  void take_arrived();

  /// The buffers, one behind the other; −1: there are none.
  int memory() const { return memory_; }
  std::size_t memory_bytes() const { return buffers_.size() * buffer_bytes_; }

 private:
  enum class State { kWithProgram, kQueued, kFilled };
  struct Buffer {
    State state = State::kWithProgram;
    std::uint32_t sequence = 0, bytes = 0;
    timeval stamp{};
  };

  int answer_about_itself(std::uint32_t request, void* argument);
  int answer_about_buffers(const Opener& by, std::uint32_t request, void* argument);
  void describe(v4l2_capability& capability) const;
  int describe(v4l2_fmtdesc& format) const;
  int describe(v4l2_frmsizeenum& size) const;
  int describe(v4l2_frmivalenum& interval) const;
  int describe(v4l2_input& input) const;
  int describe(v4l2_streamparm& parameters) const;
  v4l2_pix_format described(const PixelFormat& format) const;
  int set_format(v4l2_format& format, bool tries_only);
  int request_buffers(const Opener& by, v4l2_requestbuffers& request);
  void describe(std::uint32_t index, v4l2_buffer& buffer) const;
  int queue(v4l2_buffer& buffer);
  int dequeue(v4l2_buffer& buffer);
  int stream();
  void stop();
  void free_buffers();
  void fill(const uav::CameraSample& image);

  std::string sensor_;
  unsigned number_;
  int width_px_, height_px_;
  v4l2_fract period_s_;
  Images images_;

  const PixelFormat* format_;
  const Opener* owner_ = nullptr;  // who has the buffers
  std::vector<Buffer> buffers_;
  std::size_t buffer_bytes_ = 0;
  int memory_ = -1;
  std::uint8_t* mapped_ = nullptr;
  std::deque<std::uint32_t> queued_, filled_;  // buffers, in order
  bool is_streaming_ = false;
  ExecTime streams_since_{};
  std::optional<std::uint64_t> first_index_;  // of the images since then
};

}  // namespace tether::as_is
