#include "files/mesh_companions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether::sim {
namespace {

using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

std::filesystem::path write(const ScratchFolder& folder, const std::string& name,
                            const std::string& text = "") {
  std::filesystem::create_directories(folder.path(name).parent_path());
  return folder.write(name, text);
}

TEST(MeshCompanions, AreTheFilesThatTheMeshNames) {
  const ScratchFolder folder;
  const auto beside = write(folder, "m/meshes/A.PNG");
  const auto above = write(folder, "m/materials/textures/b c.jpg");
  const auto buffer = write(folder, "m/meshes/parts/d.bin");
  write(folder, "m/meshes/unused.png");
  write(folder, "m/meshes/notes.txt");
  const auto mesh =
      write(folder, "m/meshes/x.dae",
            "<init_from>C:\\pictures\\a.png</init_from> ../b%20c.jpg d.bin notes.txt");
  EXPECT_THAT(mesh_companions(mesh), UnorderedElementsAre(beside, above, buffer));
}

TEST(MeshCompanions, AlsoAreThoseOfItsLibrary) {
  const ScratchFolder folder;
  const auto library = write(folder, "x.mtl", "newmtl a\nmap_Kd wall.png\n");
  const auto picture = write(folder, "textures/wall.png");
  EXPECT_THAT(mesh_companions(write(folder, "x.obj", "mtllib x.mtl\n")),
              UnorderedElementsAre(library, picture));
}

TEST(MeshCompanions, OfOneNameTheNearestCounts) {
  const ScratchFolder folder;
  const auto near = write(folder, "m/meshes/a.png");
  write(folder, "m/materials/textures/a.png");
  EXPECT_THAT(mesh_companions(write(folder, "m/meshes/x.dae", "a.png")),
              UnorderedElementsAre(near));
  EXPECT_THAT(mesh_companions(write(folder, "m/meshes/y.stl", "solid")), IsEmpty());
}

}  // namespace
}  // namespace tether::sim
