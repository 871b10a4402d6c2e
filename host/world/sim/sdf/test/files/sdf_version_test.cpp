#include "sdf_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/sim_sdf/load_world.h>

namespace tether::sim {
namespace {

const SdfReader kGazebo11{"Gazebo 11", 1, 7};

std::string world_of(const std::string& version, const std::string& content) {
  return "<?xml version='1.0'?>\n<!-- a world -->\n<sdf version='" + version +
         "'>\n<world name='w'>\n" + content + "</world>\n</sdf>\n";
}

World world_with(const ScratchFolder& folder, const std::string& version,
                 const std::string& content) {
  return load({folder.write("w.sdf", world_of(version, content)), {}, {}}).world;
}

void expect_refused(const World& world, const std::filesystem::path& file, int line) {
  expect_error(bad_file_error([&] { check_sdf_version(world, kGazebo11); }), file, line, "");
}

TEST(SdfVersion, MayBeTheReadersOrEarlier) {
  const ScratchFolder folder;
  World world = world_with(folder, "1.7", "");
  world.files.insert(folder.write("uav.sdf", "<sdf version='1.9'/>"));  // UAVs are not the reader's
  check_sdf_version(world, kGazebo11);
  check_sdf_version(world_with(folder, "1.6", ""), kGazebo11);
  check_sdf_version(world_with(folder, "1.9", ""), {"Gazebo Fortress", 1, 9});
}

TEST(SdfVersion, MayNotBeLater) {
  const ScratchFolder folder;
  expect_refused(world_with(folder, "1.9", ""), folder.path("w.sdf"), 3);
  folder.write("thing/model.config",
               "<model><name>thing</name><sdf version='1.8'>model.sdf</sdf></model>");
  const auto included = folder.write(
      "thing/model.sdf",
      "<sdf version='1.8'><model name='thing'><static>true</static><link name='l'/></model>"
      "</sdf>");
  expect_refused(world_with(folder, "1.7", "<include><uri>thing</uri></include>"), included, 1);
}

TEST(SdfVersion, DecidesWhichShapesThereMayBe) {
  const ScratchFolder folder;
  const World world = world_with(folder, "1.7", R"(<model name='m'><static>true</static>
      <link name='l'><collision name='c'>
        <geometry><capsule><radius>1</radius><length>2</length></capsule></geometry>
      </collision></link></model>)");
  expect_refused(world, folder.path("w.sdf"), 7);
  check_sdf_version(world, {"Gazebo Fortress", 1, 9});
}

TEST(SdfVersion, CannotBeReadOfAFileThatIsGone) {
  World world;
  world.sdf_files = {"/nowhere/w.sdf"};
  expect_refused(world, "/nowhere/w.sdf", 0);
}

}  // namespace
}  // namespace tether::sim
