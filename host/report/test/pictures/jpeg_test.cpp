#include "pictures/jpeg.h"

#include <gtest/gtest.h>

#include <tether/record/png.h>

namespace tether::report {
namespace {

std::vector<std::uint8_t> picture_png(int width_px, int height_px) {
  std::vector<std::uint8_t> rgb;
  for (int i = 0; i < width_px * height_px; ++i) {
    rgb.push_back(static_cast<std::uint8_t>(i % width_px * 255 / width_px));
    rgb.push_back(static_cast<std::uint8_t>(i / width_px * 255 / height_px));
    rgb.push_back(77);
  }
  return record::encode_png(width_px, height_px, rgb);
}

TEST(Jpeg, IsACompleteFileOfTheSameImage) {
  const auto jpeg = jpeg_from_png(picture_png(64, 48));
  ASSERT_TRUE(jpeg);
  ASSERT_GT(jpeg->size(), 300u);
  // Start and end of image (ITU-T T.81, table B.1).
  EXPECT_EQ((*jpeg)[0], 0xff);
  EXPECT_EQ((*jpeg)[1], 0xd8);
  EXPECT_EQ((*jpeg)[jpeg->size() - 2], 0xff);
  EXPECT_EQ(jpeg->back(), 0xd9);
  EXPECT_EQ(jpeg, jpeg_from_png(picture_png(64, 48)));
  EXPECT_NE(jpeg, jpeg_from_png(picture_png(48, 64)));
}

TEST(Jpeg, OfOtherBytesIsNone) {
  EXPECT_FALSE(jpeg_from_png(std::vector<std::uint8_t>(100, 1)));
  EXPECT_FALSE(jpeg_from_png({}));
  std::vector<std::uint8_t> truncated = picture_png(64, 48);
  truncated.resize(truncated.size() / 2);
  EXPECT_FALSE(jpeg_from_png(truncated));
}

}  // namespace
}  // namespace tether::report
