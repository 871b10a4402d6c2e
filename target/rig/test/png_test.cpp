#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include <tether/rig/png.h>

namespace tether::rig {
namespace {

TEST(PngOf, KeepsEveryPixel) {
  uav::CameraSample image;
  image.width_px = 3;
  image.height_px = 2;
  image.rgb = {255, 0, 0, 0, 255, 0, 0, 0, 255, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  const Result<std::string> png = png_of(image);
  ASSERT_TRUE(png);
  const std::vector<char> bytes(png->begin(), png->end());
  const cv::Mat read = cv::imdecode(bytes, cv::IMREAD_COLOR);
  ASSERT_EQ(read.size(), cv::Size(3, 2));
  EXPECT_EQ(read.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 0, 255)) << "red";
  EXPECT_EQ(read.at<cv::Vec3b>(1, 2), cv::Vec3b(9, 8, 7));
}

}  // namespace
}  // namespace tether::rig
