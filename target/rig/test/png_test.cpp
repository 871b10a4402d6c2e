#include <vector>

#include <gtest/gtest.h>
#include <png.h>

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
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&header, png->data(), png->size()), 0);
  EXPECT_EQ(header.width, 3u);
  EXPECT_EQ(header.height, 2u);
  EXPECT_EQ(header.format, png_uint_32{PNG_FORMAT_RGB});
  std::vector<std::uint8_t> read(PNG_IMAGE_SIZE(header));
  ASSERT_NE(png_image_finish_read(&header, nullptr, read.data(), 0, nullptr), 0);
  EXPECT_EQ(read, image.rgb);
}

}  // namespace
}  // namespace tether::rig
