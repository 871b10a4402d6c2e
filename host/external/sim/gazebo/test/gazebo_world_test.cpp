#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/sim_gazebo/gazebo_simulator.h>

namespace tether::sim {
namespace {

using ::testing::HasSubstr;

/// A world file with that in its world, from line 3 on.
void check(const std::string& content) {
  const ScratchFolder folder;
  World world;
  world.sdf_files = {folder.write(
      "w.sdf", "<sdf version='1.7'>\n<world name='w'>\n" + content + "</world>\n</sdf>\n")};
  check_gazebo_world(world);
}

void expect_refused(const std::string& content, int line, const std::string& subject,
                    const std::string& value = "") {
  const Error error = bad_file_error([&] { check(content); });
  EXPECT_EQ(error.where().line, line) << error.what();
  EXPECT_EQ(error.subject(), subject);
  EXPECT_THAT(error.what(), HasSubstr(value));
}

std::string mesh(const std::string& uri) {
  return "<model name='m'><link name='l'><visual name='v'>\n<geometry><mesh><uri>" + uri +
         "</uri></mesh></geometry></visual></link></model>\n";
}

TEST(GazeboWorld, MayHaveElementsThatGazeboReadsAlike) {
  for (const std::string& content :
       {mesh("model://pyramid/meshes/pyramid.obj"), mesh(" /there/pyramid.obj\n"),
        mesh("file:///there/pyramid.obj"),
        std::string("<include><uri>model://thing</uri></include>"),
        std::string("<physics type='ode'/>"), std::string("<physics name='p'/>"),
        "<plugin name='p' filename='p.so'>" + mesh("a.obj") + "<actor/></plugin>"})
    EXPECT_NO_THROW(check(content)) << content;
}

TEST(GazeboWorld, MayNotHaveOthers) {
  for (const std::string uri : {"meshes/pyramid.obj", "file://meshes/pyramid.obj", ""})
    expect_refused(mesh(uri), 4, "<uri>", "'" + uri + "'");
  expect_refused("<include><uri>thing</uri></include>", 3, "<uri>", "'thing'");
  expect_refused("\n<actor name='a'/>", 4, "<actor>");
  for (const std::string engine : {"bullet", "simbody", "dart"})
    expect_refused("<physics type='" + engine + "'/>", 3, "<physics>", "'" + engine + "'");
}

TEST(GazeboWorld, MustStillExist) {
  World world;
  world.sdf_files = {"/nowhere/w.sdf"};
  EXPECT_EQ(bad_file_error([&] { check_gazebo_world(world); }).where().file, "/nowhere/w.sdf");
}

}  // namespace
}  // namespace tether::sim
