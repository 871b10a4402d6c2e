#include "camera/pixels.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <linux/videodev2.h>

namespace tether::as_is {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes converted(std::uint32_t code, const Bytes& rgb, int width_px, int height_px = 1) {
  const PixelFormat& format = pixel_format(code);
  Bytes out(format.image_bytes(width_px, height_px));
  format.convert(rgb, width_px, height_px, out.data());
  return out;
}

TEST(AsIsPixels, OrdersColoursAsTheFormatSays) {
  const Bytes rgb{1, 2, 3, 4, 5, 6};
  EXPECT_EQ(converted(V4L2_PIX_FMT_RGB24, rgb, 2), rgb);
  EXPECT_EQ(converted(V4L2_PIX_FMT_BGR24, rgb, 2), (Bytes{3, 2, 1, 6, 5, 4}));
}

TEST(AsIsPixels, WhiteAndBlackHaveTheLimitsOfTheirFormat) {
  const Bytes rgb{255, 255, 255, 0, 0, 0};
  EXPECT_EQ(converted(V4L2_PIX_FMT_GREY, rgb, 2), (Bytes{255, 0}));
  EXPECT_EQ(converted(V4L2_PIX_FMT_YUYV, rgb, 2), (Bytes{235, 128, 16, 128}));
}

// By the inverse of BT.601, as programs convert it.
TEST(AsIsPixels, YuyvConvertsBackToTheSameColour) {
  for (int colour = 0; colour < 512; ++colour) {
    const std::array<int, 3> wanted{(colour & 7) * 36, (colour >> 3 & 7) * 36, (colour >> 6) * 36};
    Bytes rgb;
    for (std::size_t i = 0; i < 6; ++i) rgb.push_back(static_cast<std::uint8_t>(wanted[i % 3]));
    const Bytes yuyv = converted(V4L2_PIX_FMT_YUYV, rgb, 2);
    const double y = 1.164 * (yuyv[0] - 16), u = yuyv[1] - 128.0, v = yuyv[3] - 128.0;
    EXPECT_EQ(yuyv[0], yuyv[2]);
    EXPECT_NEAR(y + 1.596 * v, wanted[0], 3.0);
    EXPECT_NEAR(y - 0.813 * v - 0.391 * u, wanted[1], 3.0);
    EXPECT_NEAR(y + 2.018 * u, wanted[2], 3.0);
  }
}

TEST(AsIsPixels, AnOddWidthEndsWithAWholePair) {
  const Bytes rgb(3 * 3 * 2, 200);
  EXPECT_EQ(pixel_format(V4L2_PIX_FMT_YUYV).line_bytes(3), 8U);
  const Bytes yuyv = converted(V4L2_PIX_FMT_YUYV, rgb, 3, 2);
  EXPECT_EQ(yuyv.size(), 16U);
  EXPECT_EQ(yuyv[4], yuyv[6]);
  EXPECT_EQ(yuyv[0], yuyv[8]);
}

TEST(AsIsPixels, AnUnknownFormatBecomesTheFirstOne) {
  EXPECT_EQ(pixel_format(V4L2_PIX_FMT_H264).code, pixel_formats().front().code);
}

}  // namespace
}  // namespace tether::as_is
