#include "test_scenes.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tether/sim_raster/scene.h>

namespace tether::raster {
namespace {

/// Somewhere else, as long as `owner` lives.
TextureSet copied(const TextureSet& set, std::weak_ptr<const void>& owner) {
  const auto bytes = std::make_shared<std::vector<std::string>>();
  for (const std::string_view array : set.arrays()) bytes->emplace_back(array);
  owner = bytes;
  const std::vector<std::string_view> arrays(bytes->begin(), bytes->end());
  return TextureSet(arrays, bytes);
}

TEST(TextureSet, OfItsArraysIsDrawnAsTheTextures) {
  SceneParts parts = rich_parts();
  const std::uint64_t drawn = hash_of(draw(Scene(parts), small_camera()));
  std::weak_ptr<const void> owner;
  parts.texture_set = copied(TextureSet(parts.textures), owner);
  EXPECT_EQ(parts.texture_set->size(), parts.textures.size());
  parts.textures.clear();
  const Scene scene(parts);
  parts.texture_set.reset();
  EXPECT_EQ(hash_of(draw(scene, small_camera())), drawn);
  EXPECT_FALSE(owner.expired());
}

TEST(TextureSet, RefusesOtherArrays) {
  const TextureSet set({noise(1, 4, 4)});
  std::vector<std::string_view> arrays = set.arrays();
  for (const std::size_t bad : {0U, 1U, 2U}) {
    std::vector<std::string_view> shorter = arrays;
    shorter[bad].remove_suffix(1);
    EXPECT_THROW(TextureSet(shorter, nullptr), std::invalid_argument) << bad;
  }
  arrays.pop_back();
  EXPECT_THROW(TextureSet(arrays, nullptr), std::invalid_argument);
}

}  // namespace
}  // namespace tether::raster
