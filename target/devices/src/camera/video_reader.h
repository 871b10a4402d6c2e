#pragma once

#include "camera/frame_source.h"

#include <memory>
#include <string>

#include <tether/base/result.h>

namespace tether::devices {

/// What to ask of a camera; 0: whatever it gives.
struct WantedFormat {
  int width_px = 0;
  int height_px = 0;
  double rate_hz = 0.0;
};

/// OpenCV's reader of videos. Each function gives null where OpenCV cannot open it. Nothing is
/// written to the standard error, unless OPENCV_FFMPEG_LOGLEVEL or OPENCV_FFMPEG_DEBUG is set. A
/// read of a device waits for 10 s at most (OpenCV's own limit), one of a stream for as long as its
/// time-out.
struct VideoReader {
  using Source = std::unique_ptr<FrameSource>;
  /// A Video4Linux device. The driver may give another format than the wanted one.
  Source (*open_device)(const std::string& path, const WantedFormat& wanted);
  /// A video file, through FFmpeg where OpenCV has it.
  Source (*open_file)(const std::string& path);
  /// A stream's URL, through FFmpeg: of the libraries behind OpenCV 4.6 it is the one whose reads
  /// can be given a time-out.
  Source (*open_stream)(const std::string& url, int timeout_ms);
};

/// Loads the reader, once. It is a shared object of its own, because the 220 libraries behind it
/// would add 0.12 s of CPU time to each start. Fails with kInvalid if the file is missing.
/// Thread-safe.
Result<const VideoReader*> video_reader();

}  // namespace tether::devices
