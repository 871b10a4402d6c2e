#include "meshes/texture_file.h"

#include "test_simulator.h"

#include <fstream>

#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>

namespace tether::sim {
namespace {

using testing::no_warnings;

std::array<int, 3> pixel(const raster::Texture& texture, int column, int row) {
  const auto at = static_cast<std::size_t>(4 * (row * texture.width_px + column));
  return {texture.rgba[at], texture.rgba[at + 1], texture.rgba[at + 2]};
}

// quarters.png: red, green (above), blue, white (below).
TEST(TextureFile, APngIsReadFromTheTopDown) {
  const raster::Texture texture =
      load_texture(std::filesystem::path(TETHER_TEST_DIR) / "data/quarters.png", no_warnings());
  const int right = texture.width_px - 1;
  const int bottom = texture.height_px - 1;
  EXPECT_EQ(pixel(texture, 0, 0), (std::array{255, 0, 0}));
  EXPECT_EQ(pixel(texture, right, 0), (std::array{0, 255, 0}));
  EXPECT_EQ(pixel(texture, 0, bottom), (std::array{0, 0, 255}));
  EXPECT_EQ(pixel(texture, right, bottom), (std::array{255, 255, 255}));
}

TEST(TextureFile, SixteenBitsMeanWhatEightDo) {
  const auto file = std::filesystem::path(TETHER_TEST_DIR) / "data/grey_16_bits.png";
  EXPECT_EQ(pixel(load_texture(file, no_warnings()), 0, 0), (std::array{128, 128, 128}));
}

std::string grey_jpeg() {
  const std::vector<unsigned char> grey(16 * 16 * 3, 90);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const tjhandle writer = tjInitCompress();
  EXPECT_EQ(tjCompress2(writer, grey.data(), 16, 0, 16, TJPF_RGB, &bytes, &size, TJSAMP_444, 95, 0),
            0);
  std::string jpeg(reinterpret_cast<char*>(bytes), size);
  tjFree(bytes);
  tjDestroy(writer);
  return jpeg;
}

TEST(TextureFile, AJpegIsRead) {
  const ScratchFolder scratch;
  const auto file = scratch.write("a", grey_jpeg());
  const raster::Texture texture = load_texture(file, no_warnings());
  EXPECT_EQ(texture.width_px, 16);
  EXPECT_NEAR(pixel(texture, 8, 8)[1], 90, 1);
  EXPECT_EQ(texture.rgba[3], 255);
}

TEST(TextureFile, WarnsOfATruncatedJpeg) {
  const ScratchFolder scratch;
  const std::string jpeg = grey_jpeg();
  const auto file = scratch.write("a", jpeg.substr(0, jpeg.size() - 12));
  std::vector<Warning> warnings;
  load_texture(file, [&](const Warning& warning) { warnings.push_back(warning); });
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].where.file, file);
}

TEST(TextureFile, RefusesWhatIsNoPicture) {
  const ScratchFolder scratch;
  for (const char* text : {"no picture", "\xff\xd8 no picture", ""}) {
    const auto file = scratch.write("picture", text);
    EXPECT_EQ(bad_file_error([&] { load_texture(file, no_warnings()); }).where().file, file);
  }
  const auto none = scratch.path("none.png");
  EXPECT_EQ(bad_file_error([&] { load_texture(none, no_warnings()); }).where().file, none);
}

}  // namespace
}  // namespace tether::sim
