#include "opencv_source.h"

#include "video_file.h"

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether::devices {
namespace {

const cv::Scalar kRed(0, 0, 250);
const cv::Scalar kBlue(250, 0, 0);

class OpencvSourceTest : public testing::Test {
 protected:
  ScratchFolder scratch_;
};

TEST_F(OpencvSourceTest, SaysTheFormatOfAFile) {
  write_video(scratch_.path("a.avi"), {kRed, kBlue}, 12.0, {80, 48});
  const auto source = open_video_file(scratch_.path("a.avi"));
  ASSERT_NE(source, nullptr);
  EXPECT_EQ(source->format().width_px, 80);
  EXPECT_EQ(source->format().height_px, 48);
  EXPECT_NEAR(source->format().rate_hz, 12.0, 1e-3);
}

TEST_F(OpencvSourceTest, GivesImagesInOrderAsRgb) {
  write_video(scratch_.path("a.avi"), {kRed, kBlue});
  const auto source = open_video_file(scratch_.path("a.avi"));
  ASSERT_NE(source, nullptr);
  uav::CameraSample image;
  ASSERT_TRUE(source->grab());
  for (int again = 0; again < 2; ++again) {
    ASSERT_TRUE(source->retrieve(image));
    ASSERT_EQ(image.rgb.size(), 3u * 64u * 48u);
    EXPECT_EQ(image.width_px, 64);
    EXPECT_EQ(image.height_px, 48);
    EXPECT_GT(image.rgb[0], 230);
    EXPECT_LT(image.rgb[2], 20);
  }
  ASSERT_TRUE(source->grab());
  ASSERT_TRUE(source->retrieve(image));
  EXPECT_LT(image.rgb[0], 20);
  EXPECT_GT(image.rgb[2], 230);
  EXPECT_FALSE(source->grab());
  EXPECT_FALSE(source->grab());
}

TEST_F(OpencvSourceTest, SkippedImagesNeedNotBeRetrieved) {
  write_video(scratch_.path("a.avi"), {kRed, kRed, kRed, kBlue});
  const auto source = open_video_file(scratch_.path("a.avi"));
  ASSERT_NE(source, nullptr);
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(source->grab());
  uav::CameraSample image;
  ASSERT_TRUE(source->retrieve(image));
  EXPECT_GT(image.rgb[2], 230);
}

TEST_F(OpencvSourceTest, GivesNoneForWhatItCannotOpen) {
  EXPECT_EQ(open_video_file(scratch_.write("a.avi", "no video")), nullptr);
  EXPECT_EQ(open_video_file(scratch_.write("empty.avi", "")), nullptr);
  EXPECT_EQ(open_video_file(scratch_.path("missing.avi")), nullptr);
  EXPECT_EQ(open_video4linux("/dev/null", {}), nullptr);
  EXPECT_EQ(open_video4linux(scratch_.path("missing"), {}), nullptr);
}

TEST_F(OpencvSourceTest, AStreamMayBeAFileToo) {
  write_video(scratch_.path("a.avi"), {kRed, kBlue});
  const auto source = open_stream("file://" + scratch_.path("a.avi").string(), 1000);
  ASSERT_NE(source, nullptr);
  EXPECT_TRUE(source->grab());
  EXPECT_TRUE(source->grab());
  EXPECT_FALSE(source->grab());
  EXPECT_EQ(open_stream("file://" + scratch_.path("missing.avi").string(), 1000), nullptr);
}

}  // namespace
}  // namespace tether::devices
