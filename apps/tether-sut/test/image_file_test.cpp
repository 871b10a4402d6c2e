#include "image_file.h"

#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include <tether/base_testing/scratch_folder.h>

namespace tether::sut {
namespace {

TEST(WritePng, KeepsEveryPixel) {
  uav::CameraSample image;
  image.width_px = 3;
  image.height_px = 2;
  image.rgb = {255, 0, 0, 0, 255, 0, 0, 0, 255, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  const ScratchFolder folder;
  const std::string path = folder.path("image.png");
  ASSERT_TRUE(write_png(path, image));
  const cv::Mat read = cv::imread(path);
  ASSERT_EQ(read.size(), cv::Size(3, 2));
  EXPECT_EQ(read.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 0, 255)) << "red";
  EXPECT_EQ(read.at<cv::Vec3b>(1, 2), cv::Vec3b(9, 8, 7));
}

TEST(WritePng, FailsWithTheFilesName) {
  uav::CameraSample image;
  image.width_px = image.height_px = 1;
  image.rgb = {1, 2, 3};
  const Status status = write_png("/nowhere/a.png", image);
  ASSERT_FALSE(status);
  EXPECT_TRUE(status.failure().message.starts_with("/nowhere/a.png: "));
}

}  // namespace
}  // namespace tether::sut
