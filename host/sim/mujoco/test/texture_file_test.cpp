#include "texture_file.h"

#include "scene.h"
#include "test_simulator.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>

namespace tether::sim {
namespace {

const std::filesystem::path kJpeg =
    std::filesystem::path(TETHER_SOURCE_DIR) / "target/calibration/data/frame1.jpg";

TEST(TextureFileTest, JpegIsATextureOfTheEngine) {
  World world = testing::test_world();
  world.models[0].links[0].visuals[0].material.albedo_map = kJpeg;
  const ModelPtr model = make_scene_model(make_scene(world, testing::no_warnings()), 64, 48);
  ASSERT_GE(model->ntex, 1);
  EXPECT_EQ(model->tex_width[0], 640);
  EXPECT_EQ(model->tex_height[0], 480);
  const std::vector<mjtByte> rgb(model->tex_rgb, model->tex_rgb + 3 * 640 * 480);
  EXPECT_GT(*std::ranges::max_element(rgb) - *std::ranges::min_element(rgb), 100) << "a picture";
}

TEST(TextureFileTest, RefusesWhatIsNoImage) {
  const ScratchFolder folder;
  for (const char* text : {"", "\xff\xd8 and no more"}) {
    const auto file = folder.write("t.jpg", text);
    EXPECT_EQ(bad_file_error([&] { texture_file("t", file); }).where().file, file.string());
  }
}

}  // namespace
}  // namespace tether::sim
