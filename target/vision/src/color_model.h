#pragma once

#include <opencv2/core.hpp>

#include <tether/uav/math.h>
#include <tether/vision/anchor_tracker.h>

namespace tether::vision {

struct HueSaturationValue {
  double hue_deg = 0.0;     // [0, 360)
  double saturation = 0.0;  // 0..1
  double value = 0.0;       // 0..1
};

HueSaturationValue hsv_from_rgb(const uav::Vec3& rgb);

/// How probably a pixel belongs to something of one colour: a hue histogram, made from the colour
/// itself with a tolerance for shading and noise, and limits of saturation and value.
class ColorModel {
 public:
  ColorModel(const uav::Vec3& color_rgb, const TrackerOptions& options);

  /// `hsv`: 8-bit, hue in units of 2°. `probability` becomes 8-bit, 0..255, of the same size.
  void back_project(const cv::Mat& hsv, cv::Mat& probability);
  /// 0..255 for one hue, whatever its saturation and value.
  double weight_of_hue(int hue_2deg) const { return histogram_.at<float>(hue_2deg); }

 private:
  cv::Mat histogram_;  // 180 × 1, float, 0..255
  cv::Scalar lowest_, highest_;
  cv::Mat mask_;
};

}  // namespace tether::vision
