#include "prepared_scene.h"

#include <gtest/gtest.h>

namespace tether::raster {
namespace {

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
  ASSERT_EQ(scene.levels[1].width, 2);
  EXPECT_EQ(scene.texels[5] & 0xFFU, 18U);
  EXPECT_EQ(scene.texels[6] & 0xFFU, 42U);
}

TEST(Texture, KeepsTheRightNeighbourOfEachPixel) {
  PreparedScene scene;
  add_texture({2, 1, {1, 0, 0, 255, 2, 0, 0, 255}}, scene);
  EXPECT_EQ(scene.texels[0] >> 32U, scene.texels[1] & 0xFFFFFFFFU);
  EXPECT_EQ(scene.texels[1] >> 32U, scene.texels[0] & 0xFFFFFFFFU);
}

}  // namespace
}  // namespace tether::raster
