#include "scene_textures.h"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether::sim {
namespace {

namespace fs = std::filesystem;

// Files of the repository are old enough to be kept; links to them are as old.
const fs::path kData = fs::path(TETHER_TEST_DIR) / "data";

struct Textures {
  raster::SceneParts parts;
  std::vector<Warning> warnings;
  std::vector<std::string> pixels;  // of the drawn textures
};

class SceneTextures : public ::testing::Test {
 protected:
  /// With a material for each source.
  Textures read(const std::optional<FileCache>& cache) const {
    Textures result;
    for (std::size_t i = 0; i < sources_.size(); ++i)
      result.parts.materials.emplace_back().texture = i;
    const auto collect = [&](const Warning& warning) { result.warnings.push_back(warning); };
    add_textures(sources_, false, collect, cache, result.parts);
    const raster::TextureSet set = result.parts.texture_set
                                       ? *result.parts.texture_set
                                       : raster::TextureSet(result.parts.textures);
    for (const std::string_view array : set.arrays()) result.pixels.emplace_back(array);
    return result;
  }
  void link(const fs::path& to) const {
    fs::remove(folder_.path("linked.png"));
    fs::create_symlink(to, folder_.path("linked.png"));
  }

  ScratchFolder folder_;
  const FileCache cache_{folder_.path("cache")};
  std::vector<TextureSource> sources_{{kData / "quarters.png", {}}};
};

TEST_F(SceneTextures, AreTheSameFromTheCache) {
  sources_.push_back({kData / "tetra.stl", {"world.sdf", 7}});  // no picture
  sources_.push_back(
      {{}, {}, std::make_shared<raster::Texture>(raster::Texture{1, 2, {1, 2, 3, 4, 5, 6, 7, 8}})});
  const Textures without = read(std::nullopt), cold = read(cache_), warm = read(cache_);
  EXPECT_FALSE(without.parts.texture_set);
  EXPECT_TRUE(warm.parts.textures.empty());
  ASSERT_EQ(without.warnings.size(), 1U);
  for (const Textures& other : {cold, warm}) {
    EXPECT_EQ(other.warnings, without.warnings);
    EXPECT_TRUE(other.pixels == without.pixels);
    EXPECT_EQ(other.parts.materials[0].texture, 0U);
    EXPECT_EQ(other.parts.materials[1].texture, std::nullopt);
    EXPECT_EQ(other.parts.materials[2].texture, 1U);
  }
  EXPECT_EQ(cache_.size().entries, 1U);
}

TEST_F(SceneTextures, AreReadAgainIfAFileIsAnotherOne) {
  link(kData / "quarters.png");
  sources_ = {{folder_.path("linked.png"), {}}};
  const Textures first = read(cache_);
  link(kData / "tetra.stl");
  const Textures second = read(cache_);
  EXPECT_TRUE(first.warnings.empty());
  EXPECT_EQ(second.warnings.size(), 1U);
  EXPECT_EQ(cache_.size().entries, 2U);
}

TEST_F(SceneTextures, AreNotKeptIfAFileIsNew) {
  folder_.write("new.png", "no picture");
  sources_.push_back({folder_.path("new.png"), {}});
  EXPECT_EQ(read(cache_).warnings.size(), 1U);
  EXPECT_EQ(cache_.size().entries, 0U);
}

}  // namespace
}  // namespace tether::sim
