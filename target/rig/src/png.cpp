#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <tether/rig/png.h>

namespace tether::rig {

Result<std::string> png_of(const uav::CameraSample& image) {
  // OpenCV has no view of constant data; this one is only read.
  const cv::Mat rgb(image.height_px, image.width_px, CV_8UC3,
                    const_cast<std::uint8_t*>(image.rgb.data()));  // NOLINT
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  std::vector<unsigned char> png;
  if (!cv::imencode(".png", bgr, png)) {
    return Failure{Failure::Kind::kInvalid, "the image cannot be encoded as PNG"};
  }
  return std::string(png.begin(), png.end());
}

}  // namespace tether::rig
