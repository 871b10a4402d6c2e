#include "sdf_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/sim_sdf/sdf_version.h>

namespace tether::sim {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;

const SdfReader kGazebo11{"Gazebo 11", 1, 7};

std::string world_of(const std::string& version, const std::string& content) {
  return "<?xml version='1.0'?>\n<!-- a world -->\n<sdf version='" + version +
         "'>\n<world name='w'>\n" + content + "</world>\n</sdf>\n";
}

std::string refusal_of(const World& world, const SdfReader& reader) {
  try {
    check_sdf_version(world, reader);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadFile);
    return error.what();
  }
  return {};
}

World world_with(const ScratchFolder& folder, const std::string& version,
                 const std::string& content) {
  return load({folder.write("w.sdf", world_of(version, content)), {}, {}}).world;
}

TEST(SdfVersion, LetsThroughWhatTheReaderKnows) {
  const ScratchFolder folder;
  EXPECT_EQ(refusal_of(world_with(folder, "1.7", ""), kGazebo11), "");
  EXPECT_EQ(refusal_of(world_with(folder, "1.6", ""), kGazebo11), "");
  EXPECT_EQ(refusal_of(world_with(folder, "1.9", ""), {"Gazebo Fortress", 1, 9}), "");
}

TEST(SdfVersion, NamesFileAndLineOfALaterOne) {
  const ScratchFolder folder;
  EXPECT_THAT(refusal_of(world_with(folder, "1.9", ""), kGazebo11),
              AllOf(HasSubstr("w.sdf:3: is SDF 1.9, of which Gazebo 11 reads up to 1.7; "),
                    HasSubstr("write it as SDF 1.7")));
}

TEST(SdfVersion, LooksIntoIncludedFiles) {
  const ScratchFolder folder;
  folder.write("thing/model.config",
               "<model><name>thing</name><sdf version='1.8'>model.sdf</sdf></model>");
  folder.write(
      "thing/model.sdf",
      "<sdf version='1.8'><model name='thing'><static>true</static><link name='l'/></model>"
      "</sdf>");
  const World world = world_with(folder, "1.7", "<include><uri>thing</uri></include>");
  EXPECT_THAT(refusal_of(world, kGazebo11), HasSubstr("thing/model.sdf:1: is SDF 1.8"));
}

TEST(SdfVersion, NamesShapesThatCameLater) {
  const ScratchFolder folder;
  const World world = world_with(folder, "1.7", R"(<model name='m'><static>true</static>
      <link name='l'><collision name='c'>
        <geometry><capsule><radius>1</radius><length>2</length></capsule></geometry>
      </collision></link></model>)");
  EXPECT_THAT(
      refusal_of(world, kGazebo11),
      HasSubstr("w.sdf:7: <capsule> came with SDF 1.8, of which Gazebo 11 reads up to 1.7"));
  EXPECT_EQ(refusal_of(world, {"Gazebo Fortress", 1, 9}), "");
}

TEST(SdfVersion, DoesNotLookAtTheUavs) {
  const ScratchFolder folder;
  World world = world_with(folder, "1.7", "");
  world.files.insert(folder.write("uav.sdf", "<sdf version='1.9'/>"));
  EXPECT_EQ(refusal_of(world, kGazebo11), "");
}

TEST(SdfVersion, SaysThatAFileIsGone) {
  World world;
  world.sdf_files = {"/nowhere/w.sdf"};
  EXPECT_THAT(refusal_of(world, kGazebo11), EndsWith("cannot be read any more"));
}

}  // namespace
}  // namespace tether::sim
