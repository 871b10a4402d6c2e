#include <vector>

#include <gtest/gtest.h>
#include <png.h>

#include <tether/record/png.h>

namespace tether::record {
namespace {

std::vector<std::uint8_t> gradient(int width_px, int height_px) {
  std::vector<std::uint8_t> rgb;
  for (int i = 0; i < width_px * height_px * 3; ++i) {
    rgb.push_back(static_cast<std::uint8_t>(i * 7));
  }
  return rgb;
}

TEST(Png, DecodesToTheSamePixels) {
  for (const auto& [width_px, height_px] : {std::pair(1, 1), std::pair(33, 7), std::pair(64, 48)}) {
    const auto rgb = gradient(width_px, height_px);
    const auto encoded = encode_png(width_px, height_px, rgb);
    EXPECT_EQ(encoded, encode_png(width_px, height_px, rgb));

    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_memory(&image, encoded.data(), encoded.size()), 0);
    EXPECT_EQ(image.width, static_cast<png_uint_32>(width_px));
    EXPECT_EQ(image.height, static_cast<png_uint_32>(height_px));
    image.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> decoded(rgb.size());
    ASSERT_NE(png_image_finish_read(&image, nullptr, decoded.data(), 0, nullptr), 0);
    EXPECT_EQ(decoded, rgb);
  }
}

TEST(Png, KeepsSixteenBitsAsTheyAre) {
  std::vector<std::uint16_t> grey(33 * 7);
  for (std::size_t i = 0; i < grey.size(); ++i) grey[i] = static_cast<std::uint16_t>(i * 283);
  const auto encoded = encode_png(33, 7, grey);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, encoded.data(), encoded.size()), 0);
  ASSERT_EQ(image.format, png_uint_32{PNG_FORMAT_LINEAR_Y});
  std::vector<std::uint16_t> decoded(grey.size());
  ASSERT_NE(png_image_finish_read(&image, nullptr, decoded.data(), 0, nullptr), 0);
  EXPECT_EQ(decoded, grey);
}

TEST(Png, FileAsDataUri) {
  const std::vector<std::uint8_t> file = {'f', 'o', 'o'};
  EXPECT_EQ(to_data_uri(file, "image/jpeg"), "data:image/jpeg;base64,Zm9v");
}

}  // namespace
}  // namespace tether::record
