#include "meshes/usable_meshes.h"

#include "test_simulator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether::sim {
namespace {

using ::testing::HasSubstr;

TEST(UsableMeshes, OthersAreLeftOutUnlessTheWorldIsStrict) {
  const ScratchFolder folder;
  const MeshGeometry good{
      folder.write("good.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "", {1.0, 1.0, 1.0}};
  const MeshGeometry bad{folder.write("bad.obj", "v 0 0 0\nf 1 2 9\n"), "", {1.0, 1.0, 1.0}};
  World world = testing::test_world();
  Link& link = world.models.at(0).links.at(0);
  link.visuals.resize(1);
  for (const auto& [name, mesh] : {std::pair("good", good), std::pair("bad", bad)}) {
    link.visuals.push_back(link.visuals.front());
    link.visuals.back().name = name;
    link.visuals.back().geometry = mesh;
  }
  link.collisions = {{"good", {}, good}, {"bad", {}, bad}};
  std::vector<Warning> warnings;
  const auto collect = [&](const Warning& warning) { warnings.push_back(warning); };

  World strict = world;
  strict.is_strict = true;
  leave_out_unusable_meshes(strict, MeshFiles(), collect);
  EXPECT_EQ(strict.models[0].links[0].visuals.size(), 3U);
  EXPECT_TRUE(warnings.empty());

  leave_out_unusable_meshes(world, MeshFiles(), collect);
  EXPECT_EQ(link.visuals.back().name, "good");
  ASSERT_EQ(link.collisions.size(), 1U);
  EXPECT_EQ(link.collisions[0].name, "good");
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[1].subject, "collision 'bad'");
  EXPECT_EQ(warnings[1].consequence, Consequence::kMissing);
  EXPECT_TRUE(warnings[1].can_change_verdict);
  EXPECT_THAT(warnings[1].message, HasSubstr("bad.obj"));
}

// Two tetrahedra, 10 m apart.
TEST(UsableMeshes, PiecesOfAMeshCollideEachByItself) {
  const ScratchFolder folder;
  std::string text;
  for (const int x : {10, 0})
    for (const char* const rest : {" 0 0", " 1 0", " 0 1"})
      text += "v " + std::to_string(x) + rest + "\n";
  text += "v 11 0 0\nv 1 0 0\n";
  for (const int first : {1, 4}) {
    const int apex = first == 1 ? 7 : 8;
    const auto face = [&](int a, int b, int c) {
      text += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
    };
    face(first, first + 1, first + 2);
    face(first, first + 1, apex);
    face(first + 1, first + 2, apex);
    face(first + 2, first, apex);
  }
  World world = testing::test_world();
  Link& link = world.models.at(0).links.at(0);
  const MeshGeometry mesh{folder.write("a.obj", text), "", {1.0, 1.0, 1.0}};
  link.collisions = {{"c", {}, mesh, 0.5}};
  const MeshFiles files;
  split_collisions(world, files);
  ASSERT_EQ(link.collisions.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(link.collisions[i].friction, 0.5);
    const auto corners = files.corners(std::get<MeshGeometry>(link.collisions[i].geometry));
    ASSERT_EQ(corners.size(), 4U);
    EXPECT_EQ(corners.front().x, i == 0 ? 10.0 : 0.0);
    EXPECT_EQ(corners.back().x, i == 0 ? 11.0 : 1.0);
  }
  EXPECT_EQ(files.corners(mesh).size(), 8U);
}

}  // namespace
}  // namespace tether::sim
