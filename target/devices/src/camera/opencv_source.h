#pragma once

#include "camera/frame_source.h"

#include <memory>
#include <string>

namespace tether::devices {

/// What to ask of a camera; 0: whatever it gives.
struct WantedFormat {
  int width_px = 0;
  int height_px = 0;
  double rate_hz = 0.0;
};

// Each gives null where OpenCV cannot open it. Nothing is written to the standard error, unless
// OPENCV_FFMPEG_LOGLEVEL or OPENCV_FFMPEG_DEBUG is set. A read of a device waits for 10 s at most
// (OpenCV's own limit), one of a stream for as long as its time-out.

/// A Video4Linux device. The driver may give another format than the wanted one.
std::unique_ptr<FrameSource> open_video4linux(const std::string& path, const WantedFormat& wanted);
/// A video file, through FFmpeg where OpenCV has it.
std::unique_ptr<FrameSource> open_video_file(const std::string& path);
/// A stream's URL, through FFmpeg: of the libraries behind OpenCV 4.6 it is the one whose reads can
/// be given a time-out.
std::unique_ptr<FrameSource> open_stream(const std::string& url, int timeout_ms);

}  // namespace tether::devices
