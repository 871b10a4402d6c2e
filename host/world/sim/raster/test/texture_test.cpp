#include "scene/prepared_scene.h"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace tether::raster {
namespace {

TEST(Texture, IsAveragedExactlyAtOddSizes) {
  PreparedTextures scene;
  EXPECT_EQ(add_texture({3, 1, {0, 0, 0, 255, 90, 0, 0, 255, 240, 0, 0, 255}}, scene), 2);
  ASSERT_EQ(scene.levels.size(), 2U);
  EXPECT_EQ(scene.texels.back().channels[0][1], 110 - 128);
}

TEST(Texture, WeightsPixelsByHowMuchOfThemIsCovered) {
  PreparedTextures scene;
  add_texture({5, 1, {10, 0, 0, 255, 20, 0, 0, 255, 30, 0, 0, 255, 40, 0, 0, 255, 50, 0, 0, 255}},
              scene);
  // Two and a half pixels each: (10 + 20 + 15) / 2.5 and (15 + 40 + 50) / 2.5.
  const LevelRow& half = scene.levels[1];
  ASSERT_EQ(half.width_256ths, 512.0F);
  const TexelPair* const pairs = scene.texels.data() + half.first_pair;
  EXPECT_EQ(pairs[0].channels[0][0], 18 - 128);
  EXPECT_EQ(pairs[1].channels[0][0], 42 - 128);
}

// The mean of 253, 254, 254 and 254 is 253.75; no channel spills into the next one.
TEST(Texture, IsAveragedExactlyAtEvenSizes) {
  PreparedTextures scene;
  add_texture({2, 2, {253, 0, 255, 0, 254, 0, 255, 1, 254, 0, 255, 0, 254, 1, 255, 0}}, scene);
  const TexelPair& one = scene.texels.back();
  const int expected[] = {254, 0, 255, 0};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(one.channels[i][0] + 128, expected[i]) << i;
}

TEST(Texture, NeedsTheRoomThatIsSaid) {
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 2}, {5, 1}, {7, 16}}) {
    PreparedTextures scene;
    const Texture texture{width, height,
                          std::vector<std::uint8_t>(static_cast<std::size_t>(4 * width * height))};
    add_texture(texture, scene);
    EXPECT_EQ(scene.texels.size(), texels_of(texture)) << width << " × " << height;
  }
}

TEST(Texture, RepeatsColumnsAndRowsAcrossItsEdges) {
  PreparedTextures scene;
  add_texture({2, 2, {1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0}}, scene);
  std::vector<int> upper;
  std::vector<int> lower;
  for (std::size_t i = 0; i < 12; ++i) {
    upper.push_back(scene.texels[i].channels[0][0] + 128);
    lower.push_back(scene.texels[i].channels[0][1] + 128);
  }
  EXPECT_EQ(upper, (std::vector<int>{4, 3, 4, 3, 2, 1, 2, 1, 4, 3, 4, 3}));
  EXPECT_EQ(lower, (std::vector<int>{2, 1, 2, 1, 4, 3, 4, 3, 2, 1, 2, 1}));
  EXPECT_EQ(scene.levels[0].first_pair, 5);
}

}  // namespace
}  // namespace tether::raster
