// The shared object tether-video.so: cameras, video files and streams through OpenCV.
#include "camera/video_reader.h"

#include <cmath>
#include <cstdlib>
#include <functional>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <opencv2/videoio/registry.hpp>

namespace tether::devices {
namespace {

namespace logging = cv::utils::logging;

// ---- silence: these libraries write to the standard error, where we say it better in one line

/// OpenCV's own log.
class QuietLog {
 public:
  QuietLog() : before_(logging::setLogLevel(logging::LOG_LEVEL_SILENT)) {}
  ~QuietLog() { logging::setLogLevel(before_); }
  QuietLog(const QuietLog&) = delete;
  QuietLog& operator=(const QuietLog&) = delete;

 private:
  logging::LogLevel before_;
};

/// FFmpeg's log: OpenCV asks the environment for its level once per process, when it first uses it.
/// If the user has set one of these variables, the log is kept.
void quiet_ffmpeg() {
  constexpr const char* kLevel = "OPENCV_FFMPEG_LOGLEVEL";
  constexpr const char* kQuiet = "-8";  // AV_LOG_QUIET
  if (std::getenv("OPENCV_FFMPEG_DEBUG") == nullptr) ::setenv(kLevel, kQuiet, /*overwrite=*/0);
}

/// False as well where OpenCV throws.
bool succeeds_quietly(const std::function<bool()>& call) {
  const QuietLog quiet;
  try {
    return call();
  } catch (const cv::Exception&) {
    return false;
  }
}

// ---- any source

class OpencvSource final : public FrameSource {
 public:
  // Copies of a capture are the same capture; it cannot be moved.
  explicit OpencvSource(const cv::VideoCapture& capture) : capture_(capture) {}

  ImageFormat format() const override;
  bool grab() override {
    is_retrieved_ = false;
    return succeeds_quietly([this] { return capture_.grab(); });
  }
  bool retrieve(uav::CameraSample& into) override;
  double position_ms() const override { return capture_.get(cv::CAP_PROP_POS_MSEC); }

 private:
  bool convert(uav::CameraSample& into);

  cv::VideoCapture capture_;
  cv::Mat frame_;  // kept between images, so that its memory is
  bool is_retrieved_ = false;
  cv::Size size_;  // of the first image; the others must have it too
};

ImageFormat OpencvSource::format() const {
  ImageFormat format;
  format.width_px = static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_WIDTH));
  format.height_px = static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_HEIGHT));
  // Containers without a rate give their time base instead (90 kHz), or no number.
  const double rate_hz = capture_.get(cv::CAP_PROP_FPS);
  if (std::isfinite(rate_hz) && rate_hz > 0.0 && rate_hz <= 1000.0) format.rate_hz = rate_hz;
  return format;
}

bool OpencvSource::retrieve(uav::CameraSample& into) {
  // Once per image: the first time gives the driver its buffer back, and not every version of
  // OpenCV survives a second.
  return succeeds_quietly([&] {
    if (!is_retrieved_) is_retrieved_ = capture_.retrieve(frame_);
    return is_retrieved_ && convert(into);
  });
}

bool OpencvSource::convert(uav::CameraSample& into) {
  if (frame_.depth() != CV_8U || frame_.empty()) return false;
  const int channels = frame_.channels();
  if (channels != 1 && channels != 3) return false;
  if (size_.empty()) size_ = frame_.size();
  if (size_ != frame_.size()) return false;
  into.width_px = size_.width;
  into.height_px = size_.height;
  into.rgb.resize(3 * static_cast<std::size_t>(size_.area()));
  cv::Mat rgb(size_, CV_8UC3, into.rgb.data());
  cv::cvtColor(frame_, rgb, channels == 1 ? cv::COLOR_GRAY2RGB : cv::COLOR_BGR2RGB);
  return true;
}

std::unique_ptr<FrameSource> open_with(const std::function<bool(cv::VideoCapture&)>& open) {
  quiet_ffmpeg();
  cv::VideoCapture capture;
  if (!succeeds_quietly([&] { return open(capture) && capture.isOpened(); })) return nullptr;
  return std::make_unique<OpencvSource>(capture);
}

/// The others write to the standard error with nothing to stop them, and read nothing more.
int best_for_files() {
  return cv::videoio_registry::hasBackend(cv::CAP_FFMPEG) ? cv::CAP_FFMPEG : cv::CAP_ANY;
}

// ---- each kind of source

std::unique_ptr<FrameSource> open_device(const std::string& path, const WantedFormat& wanted) {
  return open_with([&](cv::VideoCapture& capture) {
    if (!capture.open(path, cv::CAP_V4L2)) return false;
    // One buffer to fill while the other is converted: with a single one, uvcvideo drops the
    // image that begins meanwhile. Each further one would only hold images that are older.
    capture.set(cv::CAP_PROP_BUFFERSIZE, 2);
    if (wanted.width_px > 0) {
      capture.set(cv::CAP_PROP_FRAME_WIDTH, wanted.width_px);
      capture.set(cv::CAP_PROP_FRAME_HEIGHT, wanted.height_px);
    }
    if (wanted.rate_hz > 0.0) capture.set(cv::CAP_PROP_FPS, wanted.rate_hz);
    return true;
  });
}

std::unique_ptr<FrameSource> open_file(const std::string& path) {
  return open_with([&](cv::VideoCapture& capture) { return capture.open(path, best_for_files()); });
}

std::unique_ptr<FrameSource> open_stream(const std::string& url, int timeout_ms) {
  return open_with([&](cv::VideoCapture& capture) {
    return capture.open(
        url, cv::CAP_FFMPEG,
        {cv::CAP_PROP_OPEN_TIMEOUT_MSEC, timeout_ms, cv::CAP_PROP_READ_TIMEOUT_MSEC, timeout_ms});
  });
}

}  // namespace

extern "C" {
extern const VideoReader tether_video_reader;
const VideoReader tether_video_reader{open_device, open_file, open_stream};
}

}  // namespace tether::devices
