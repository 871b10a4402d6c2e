#include "image.h"

#include <gtest/gtest.h>

namespace tether::sim {
namespace {

TEST(ImageTest, TurnsUpsideDownAndDropsAlpha) {
  for (const int width : {1, 3, 4, 5, 7, 8, 9, 11, 12, 33}) {
    RawImage raw{width, 3, {}};
    for (std::uint32_t i = 0; i < 3U * static_cast<std::uint32_t>(width); ++i) {
      raw.rgba.push_back(0xFF000000U | (i * 0x010203U));
    }
    std::vector<std::uint8_t> rgb(raw.rgba.size() * 3);
    convert_to_rgb(raw, 0, rgb);
    std::size_t at = 0;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < width; ++column) {
        for (int channel = 0; channel < 3; ++channel) {
          EXPECT_EQ(rgb[at++], raw.pixel(column, row)[channel]) << width << " " << row;
        }
      }
    }
    EXPECT_EQ(rgb[0], raw.rgba[2 * static_cast<std::size_t>(width)] & 0xFFU) << "the last row";
  }
}

TEST(ImageTest, ThePixelsThatNothingIsDrawnInAreTheBackground) {
  const RawImage raw{33, 1, [] {
                       std::vector<std::uint32_t> rgba(33);
                       for (std::uint32_t i = 0; i < 33; i += 3) rgba[i] = 0xFF000000U;  // black
                       return rgba;
                     }()};
  std::vector<std::uint8_t> rgb(99);
  convert_to_rgb(raw, 0xFF030201U, rgb);
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    EXPECT_EQ(rgb[i], i / 3 % 3 == 0 ? 0 : 1 + i % 3) << i;
  }
}

}  // namespace
}  // namespace tether::sim
