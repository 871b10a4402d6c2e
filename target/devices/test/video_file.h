#pragma once

#include <string>
#include <vector>

#include <opencv2/videoio.hpp>

namespace tether::devices {

// B, G, R.
inline const cv::Scalar kRed(0, 0, 250);
inline const cv::Scalar kBlue(250, 0, 0);

/// Writes a video of plain images of these colours (B, G, R), through OpenCV's own encoder.
inline void write_video(const std::string& path, const std::vector<cv::Scalar>& colors_bgr,
                        double rate_hz = 25.0, cv::Size size = {64, 48}) {
  cv::VideoWriter writer(path, cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                         rate_hz, size);
  for (const cv::Scalar& color : colors_bgr) writer.write(cv::Mat(size, CV_8UC3, color));
}

}  // namespace tether::devices
