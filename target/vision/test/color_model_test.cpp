#include "color_model.h"

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace tether::vision {
namespace {

int probability_of(ColorModel& model, int r, int g, int b) {
  cv::Mat rgb(1, 1, CV_8UC3, cv::Scalar(r, g, b));
  cv::Mat hsv, probability;
  cv::cvtColor(rgb, hsv, cv::COLOR_RGB2HSV);
  model.back_project(hsv, probability);
  return probability.at<std::uint8_t>(0, 0);
}

TEST(Hsv, OfKnownColors) {
  struct Row {
    uav::Vec3 rgb;
    double hue_deg, saturation, value;
  };
  for (const Row& row : {Row{{1, 0, 0}, 0, 1, 1}, Row{{0, 1, 0}, 120, 1, 1},
                         Row{{0, 0, 1}, 240, 1, 1}, Row{{0.5, 0.5, 0.5}, 0, 0, 0.5},
                         Row{{1, 0, 0.5}, 330, 1, 1}, Row{{0.4, 0.4, 0.2}, 60, 0.5, 0.4}}) {
    const HueSaturationValue hsv = hsv_from_rgb(row.rgb);
    EXPECT_NEAR(hsv.hue_deg, row.hue_deg, 1e-9);
    EXPECT_NEAR(hsv.saturation, row.saturation, 1e-9);
    EXPECT_NEAR(hsv.value, row.value, 1e-9);
  }
}

TEST(ColorModel, FindsItsColorInAnyShadeAndNoOther) {
  ColorModel blue({0.1, 0.2, 0.9}, {});
  EXPECT_GT(probability_of(blue, 25, 51, 230), 240);
  EXPECT_GT(probability_of(blue, 12, 25, 115), 240);
  EXPECT_GT(probability_of(blue, 80, 98, 230), 200);
  EXPECT_EQ(probability_of(blue, 230, 30, 30), 0);
  EXPECT_EQ(probability_of(blue, 30, 230, 200), 0);
  EXPECT_EQ(probability_of(blue, 110, 112, 125), 0) << "pale";
  EXPECT_EQ(probability_of(blue, 2, 4, 20), 0) << "dark";
}

TEST(ColorModel, RedWrapsAroundTheCircle) {
  ColorModel red({0.9, 0.05, 0.05}, {});
  EXPECT_GT(probability_of(red, 230, 10, 20), 150);
  EXPECT_GT(probability_of(red, 230, 20, 10), 150);
}

}  // namespace
}  // namespace tether::vision
