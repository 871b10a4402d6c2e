#include "prepared_scene.h"

#include <vector>

#include <gtest/gtest.h>

namespace tether::raster {
namespace {

// Each size is followed by its first column and its first row.
TEST(Texture, IsAveragedExactlyAtOddSizes) {
  PreparedScene scene;
  EXPECT_EQ(add_texture({3, 1, {0, 0, 0, 255, 90, 0, 0, 255, 240, 0, 0, 255}}, scene), 2);
  ASSERT_EQ(scene.levels.size(), 2U);
  EXPECT_EQ(scene.texels.back() & 0xFFU, 110U);
}

TEST(Texture, WeightsPixelsByHowMuchOfThemIsCovered) {
  PreparedScene scene;
  add_texture({5, 1, {10, 0, 0, 255, 20, 0, 0, 255, 30, 0, 0, 255, 40, 0, 0, 255, 50, 0, 0, 255}},
              scene);
  // Two and a half pixels each: (10 + 20 + 15) / 2.5 and (15 + 40 + 50) / 2.5.
  const LevelRow& half = scene.levels[1];
  ASSERT_EQ(half.width, 2);
  const auto* const texels = scene.texels.data() + half.first_texel;
  EXPECT_EQ(texels[0] & 0xFFU, 18U);
  EXPECT_EQ(texels[1] & 0xFFU, 42U);
}

TEST(Texture, RepeatsItsFirstColumnAndRowAtItsEnd) {
  PreparedScene scene;
  add_texture({2, 2, {1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0}}, scene);
  const std::vector<std::uint32_t> largest(scene.texels.begin(), scene.texels.begin() + 9);
  EXPECT_EQ(largest, (std::vector<std::uint32_t>{1, 2, 1, 3, 4, 3, 1, 2, 1}));
}

}  // namespace
}  // namespace tether::raster
