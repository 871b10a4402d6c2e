#include "camera/camera_device.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tether::devices {
namespace {

constexpr Duration kOldestPlausible = std::chrono::seconds(5);
/// More than any driver or network buffers.
constexpr std::uint64_t kMostSkipped = 300;

/// The nearest nanosecond; none for what is no instant at all.
std::optional<Duration> from_ms(double ms) {
  if (!(ms > 0.0 && ms < 9e12)) return std::nullopt;
  return Duration(std::llround(ms * 1e6));
}

}  // namespace

// ---- any camera

Failure CameraDevice::stop(const std::string& why) {
  stopped_ =
      Failure{Failure::Kind::kDisconnected,
              label_ + " stopped after " + std::to_string(grabbed_) + " images (" + why + ")"};
  return *stopped_;
}

bool CameraDevice::grab() {
  if (!source_->grab()) return false;
  ++grabbed_;
  return true;
}

Result<uav::CameraSample> CameraDevice::read(client::Read read) {
  if (stopped_) return *stopped_;
  const bool again = read == client::Read::kLatest && taken_at_ && is_newest();
  if (!again) taken_at_ = next();
  if (!taken_at_) return stop(why_stopped());
  uav::CameraSample sample;
  if (!source_->retrieve(sample)) return stop("an image could not be decoded, or had another size");
  sample.sampled_at = time_.at(*taken_at_);
  sample.index = grabbed_ - 1;
  return sample;
}

// ---- live

LiveCamera::LiveCamera(const Timeline& time, std::string label, std::unique_ptr<FrameSource> source,
                       bool has_timestamps, std::function<std::string()> why_stopped)
    : CameraDevice(time, std::move(label), std::move(source)),
      has_timestamps_(has_timestamps),
      why_stopped_(std::move(why_stopped)) {
  const double rate_hz = format().rate_hz;
  if (rate_hz > 0.0) period_ = duration_from_seconds(1.0 / rate_hz);
}

/// How many images may be waiting that are older than the newest.
std::uint64_t LiveCamera::due_since_last() const {
  if (!last_ || period_ <= Duration::zero()) return 0;
  const auto due = (clock().now() - *last_) / period_;
  return std::min(static_cast<std::uint64_t>(std::max<std::int64_t>(due, 0)), kMostSkipped);
}

std::optional<Duration> LiveCamera::timestamp(Duration arrival) const {
  const auto taken = has_timestamps_ ? from_ms(source().position_ms()) : std::nullopt;
  const bool plausible = taken && *taken <= arrival && arrival - *taken <= kOldestPlausible &&
                         (!last_ || *taken > *last_);
  return plausible ? taken : std::nullopt;
}

std::optional<Duration> LiveCamera::next() {
  for (std::uint64_t waiting = due_since_last();; --waiting) {
    const Duration asked = clock().now();
    if (!grab()) return std::nullopt;
    const Duration arrival = clock().now();
    const std::optional<Duration> taken = timestamp(arrival);
    last_ = taken.value_or(arrival);
    const bool had_to_wait = arrival - asked >= period_ / 2;
    // Exposure, readout and transfer come after the timestamp, and take up to two periods.
    const bool is_recent = taken && arrival - *taken < 2 * period_;
    if (waiting == 0 || had_to_wait || is_recent) return last_;
  }
}

bool LiveCamera::is_newest() const {
  return last_ && clock().now() - *last_ < period_;
}

// ---- played

PlayedVideo::PlayedVideo(const Timeline& time, std::string label,
                         std::unique_ptr<FrameSource> source)
    : CameraDevice(time, std::move(label), std::move(source)), rate_hz_(format().rate_hz) {}

Result<std::unique_ptr<PlayedVideo>> PlayedVideo::create(const Timeline& time, std::string label,
                                                         std::unique_ptr<FrameSource> source,
                                                         const std::string& path) {
  if (source->format().rate_hz <= 0.0) {
    return Failure{Failure::Kind::kInvalid,
                   label +
                       ": the file has no frame rate. Convert it, for example with "
                       "`ffmpeg -i " +
                       path + " -r 30 video.avi`"};
  }
  // make_unique cannot reach the constructor.
  return std::unique_ptr<PlayedVideo>(new PlayedVideo(time, std::move(label), std::move(source)));
}

Duration PlayedVideo::due(std::uint64_t image) const {
  return *start_ + duration_from_seconds(static_cast<double>(image) / rate_hz_);
}

std::uint64_t PlayedVideo::on_now() const {
  const Duration played = clock().now() - *start_;
  auto image = static_cast<std::uint64_t>(std::max(0.0, to_seconds(played) * rate_hz_));
  // Due instants are rounded to nanoseconds, so the product may fall short of one that is now.
  if (due(image + 1) <= clock().now()) ++image;
  return image;
}

std::optional<Duration> PlayedVideo::next() {
  if (!start_) start_ = clock().now();
  const std::uint64_t image = std::max(on_now(), grabbed());
  clock().sleep_until(due(image));
  while (grabbed() <= image) {
    if (!grab()) return std::nullopt;
  }
  return due(image);
}

bool PlayedVideo::is_newest() const {
  return on_now() < grabbed();
}

}  // namespace tether::devices
