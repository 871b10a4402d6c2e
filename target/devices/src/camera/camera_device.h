#pragma once

#include "camera/frame_source.h"
#include "clock.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <tether/base/result.h>
#include <tether/client/vehicle.h>
#include <tether/uav/samples.h>

namespace tether::devices {

/// A camera, live or played. Reads fail with kDisconnected when there are no more images, and then
/// for ever.
class CameraDevice {
 public:
  virtual ~CameraDevice() = default;
  ImageFormat format() const { return source_->format(); }
  Result<uav::CameraSample> read(client::Read read);

 protected:
  CameraDevice(const Timeline& time, std::string label, std::unique_ptr<FrameSource> source)
      : time_(time), label_(std::move(label)), source_(std::move(source)) {}

  Clock& clock() const { return time_.clock(); }
  FrameSource& source() const { return *source_; }
  /// Takes the next image of the source and counts it.
  bool grab();
  /// How many images were taken from the source, wanted or not.
  std::uint64_t grabbed() const { return grabbed_; }

 private:
  /// Makes the newest image the grabbed one, and says when it was taken [CLOCK_MONOTONIC]. None:
  /// there are no more.
  virtual std::optional<Duration> next() = 0;
  /// Whether an image newer than the grabbed one cannot be there yet. @pre next() gave an instant
  virtual bool is_newest() const = 0;
  virtual std::string why_stopped() const = 0;

  Failure stop(const std::string& why);

  Timeline time_;
  std::string label_;
  std::unique_ptr<FrameSource> source_;
  std::uint64_t grabbed_ = 0;
  std::optional<Duration> taken_at_;  ///< of the image that was read last
  std::optional<Failure> stopped_;
};

/// A camera, or a stream from one.
///
/// If the program reads slowly, images wait in the driver's buffers, and the first of them are old.
/// Those that were due since the last read are therefore skipped, as long as they are there at
/// once: an image that had to be waited for, or whose timestamp is recent, is the newest.
class LiveCamera final : public CameraDevice {
 public:
  /// `has_timestamps`: the source's position is on CLOCK_MONOTONIC. It dates an image where it is
  /// plausible: not in the future, at most 5 s old, later than the one before. Else the image is
  /// from its arrival. `why_stopped` is asked when the source has no more.
  LiveCamera(const Timeline& time, std::string label, std::unique_ptr<FrameSource> source,
             bool has_timestamps, std::function<std::string()> why_stopped);

 private:
  std::optional<Duration> next() override;
  bool is_newest() const override;
  std::string why_stopped() const override { return why_stopped_(); }

  std::uint64_t due_since_last() const;
  std::optional<Duration> timestamp(Duration arrival) const;

  Duration period_{0};  ///< 0: not known
  bool has_timestamps_;
  std::function<std::string()> why_stopped_;
  std::optional<Duration> last_;  ///< when the image that was grabbed last was taken
};

/// A video file, played like a live camera: image k is there from k periods after the first read
/// on, and gone when the next one is.
class PlayedVideo final : public CameraDevice {
 public:
  /// Fails with kInvalid if the source does not say its rate. `path` is for the message.
  static Result<std::unique_ptr<PlayedVideo>> create(const Timeline& time, std::string label,
                                                     std::unique_ptr<FrameSource> source,
                                                     const std::string& path);

 private:
  PlayedVideo(const Timeline& time, std::string label, std::unique_ptr<FrameSource> source);

  std::optional<Duration> next() override;
  bool is_newest() const override;
  std::string why_stopped() const override { return "end of the file"; }

  Duration due(std::uint64_t image) const;
  /// The image that is on now. @pre playing
  std::uint64_t on_now() const;

  double rate_hz_;
  std::optional<Duration> start_;  ///< none: nothing was read yet
};

}  // namespace tether::devices
