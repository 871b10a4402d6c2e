#include "color_model.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace tether::vision {
namespace {

constexpr int kHueBins = 180;
constexpr double kDegPerBin = 2.0;

/// Histogram of a hue as it looks after shading and noise: a bell about it that ends at
/// `tolerance`.
cv::Mat hue_histogram(double hue_deg, double tolerance_deg) {
  cv::Mat histogram(kHueBins, 1, CV_32F, cv::Scalar(0));
  const double sigma_deg = 0.5 * tolerance_deg;
  for (int bin = 0; bin < kHueBins; ++bin) {
    const double off_deg = std::remainder(kDegPerBin * bin - hue_deg, 360.0);
    if (std::abs(off_deg) <= tolerance_deg) {
      const double z = off_deg / sigma_deg;
      histogram.at<float>(bin) = static_cast<float>(255.0 * std::exp(-0.5 * z * z));
    }
  }
  return histogram;
}

}  // namespace

HueSaturationValue hsv_from_rgb(const uav::Vec3& rgb) {
  const double high = std::max({rgb.x, rgb.y, rgb.z});
  const double low = std::min({rgb.x, rgb.y, rgb.z});
  const double chroma = high - low;
  if (chroma <= 0.0) return {0.0, 0.0, high};
  double sextant = 0.0;
  if (high == rgb.x) {
    sextant = (rgb.y - rgb.z) / chroma;
  } else if (high == rgb.y) {
    sextant = (rgb.z - rgb.x) / chroma + 2.0;
  } else {
    sextant = (rgb.x - rgb.y) / chroma + 4.0;
  }
  return {60.0 * (sextant < 0.0 ? sextant + 6.0 : sextant), chroma / high, high};
}

ColorModel::ColorModel(const uav::Vec3& color_rgb, const TrackerOptions& options)
    : histogram_(hue_histogram(hsv_from_rgb(color_rgb).hue_deg, options.hue_tolerance_deg)),
      lowest_(0, 255.0 * options.min_saturation, 255.0 * options.min_value),
      highest_(kHueBins, 255, 255.0 * options.max_value) {}

void ColorModel::back_project(const cv::Mat& hsv, cv::Mat& probability) {
  const int channels[] = {0};
  const float hue_range[] = {0, kHueBins};
  const float* ranges[] = {hue_range};
  cv::calcBackProject(&hsv, 1, channels, histogram_, probability, ranges);
  cv::inRange(hsv, lowest_, highest_, mask_);
  cv::bitwise_and(probability, mask_, probability);
}

}  // namespace tether::vision
