#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/base_testing/scratch_folder.h>
#include <tether/sim_gazebo/gazebo_world.h>

namespace tether::sim {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;

/// Of a world file with that in its world, from line 3 on.
std::string refusal_of(const std::string& content) {
  const ScratchFolder folder;
  World world;
  world.sdf_files = {folder.write(
      "w.sdf", "<sdf version='1.7'>\n<world name='w'>\n" + content + "</world>\n</sdf>\n")};
  try {
    check_gazebo_world(world);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadFile);
    return error.what();
  }
  return {};
}

std::string mesh(const std::string& uri) {
  return "<model name='m'><link name='l'><visual name='v'>\n<geometry><mesh><uri>" + uri +
         "</uri></mesh></geometry></visual></link></model>\n";
}

TEST(GazeboWorld, MayNameMeshesThatGazeboFinds) {
  EXPECT_EQ(refusal_of(mesh("model://pyramid/meshes/pyramid.obj")), "");
  EXPECT_EQ(refusal_of(mesh(" /there/pyramid.obj\n")), "");
  EXPECT_EQ(refusal_of(mesh("file:///there/pyramid.obj")), "");
}

TEST(GazeboWorld, MayNotNameMeshesBesideTheirFile) {
  EXPECT_THAT(
      refusal_of(mesh("meshes/pyramid.obj")),
      AllOf(HasSubstr("w.sdf:4: "), HasSubstr("'meshes/pyramid.obj'"), HasSubstr("model://")));
  EXPECT_THAT(refusal_of(mesh("file://meshes/pyramid.obj")), HasSubstr("w.sdf:4: "));
  EXPECT_THAT(refusal_of(mesh("")), HasSubstr("w.sdf:4: "));
}

TEST(GazeboWorld, MayNotIncludeByARelativePath) {
  EXPECT_EQ(refusal_of("<include><uri>model://thing</uri></include>"), "");
  EXPECT_THAT(refusal_of("<include><uri>thing</uri></include>"),
              AllOf(HasSubstr("w.sdf:3: "), HasSubstr("<include>"), HasSubstr("'thing'")));
}

TEST(GazeboWorld, MayNotHaveActors) {
  EXPECT_THAT(refusal_of("\n<actor name='a'/>"), HasSubstr("w.sdf:4: <actor>"));
}

TEST(GazeboWorld, MayHaveOdeOnly) {
  EXPECT_EQ(refusal_of("<physics type='ode'/>"), "");
  EXPECT_EQ(refusal_of("<physics name='p'/>"), "");
  for (const std::string engine : {"bullet", "simbody", "dart"})
    EXPECT_THAT(
        refusal_of("<physics type='" + engine + "'/>"),
        AllOf(HasSubstr("w.sdf:3: "), HasSubstr("'" + engine + "'"), HasSubstr("type=\"ode\"")));
}

TEST(GazeboWorld, LeavesAloneWhatIsInPlugins) {
  EXPECT_EQ(refusal_of("<plugin name='p' filename='p.so'>" + mesh("a.obj") + "<actor/></plugin>"),
            "");
}

TEST(GazeboWorld, SaysThatAFileIsGone) {
  World world;
  world.sdf_files = {"/nowhere/w.sdf"};
  try {
    check_gazebo_world(world);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), EndsWith("cannot be read any more"));
  }
}

}  // namespace
}  // namespace tether::sim
