#include "sdf_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::HasSubstr;

constexpr const char* kRobot =
    "<robot name='table'>\n"
    "<link name='base'><inertial><mass value='2'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' "
    "izz='1'/></inertial></link>\n"
    "<link name='top'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' "
    "izz='1'/></inertial><collision><geometry><box size='1 2 0.1'/></geometry></collision></link>\n"
    "<joint name='j' type='fixed'><parent link='base'/><child link='top'/>"
    "<origin xyz='0 0 0.7'/></joint>\n"
    "</robot>\n";

TEST(Urdf, IsIncludedAsItsModel) {
  const ScratchFolder folder;
  folder.write("table.urdf", kRobot);
  const auto world =
      folder.write("w.sdf",
                   "<sdf version='1.7'><world name='w'><include><uri>table.urdf</uri>"
                   "</include></world></sdf>");
  const Loaded loaded = load({world, {}, {}});
  ASSERT_EQ(loaded.world.models.size(), 1u);
  const Model& table = loaded.world.models[0];
  EXPECT_EQ(table.name, "table");
  ASSERT_EQ(table.links.size(), 1u) << "the fixed joint makes them one";
  ASSERT_EQ(table.links[0].collisions.size(), 1u);
  EXPECT_NEAR(table.links[0].collisions[0].X_LC.p.z, 0.7, 1e-9);
}

TEST(Urdf, IsRefusedIfItIsATemplateOrBroken) {
  struct BadRobot {
    std::string text;
    int line;
    const char* words;
  };
  const BadRobot cases[] = {
      {"<robot name='a' xmlns:xacro='x'>\n<xacro:include filename='b'/></robot>", 2, "Expand it"},
      {"<robot name='a'><link name='b'/><link name='c'/></robot>", 1, "root link"},
      {"<robot><link name='b'/></robot>", 1, "No name given"},
      {"<robot name='a'><link name='b'><visual><geometry><box size='1 x 2'/></geometry></visual>"
       "</link></robot>",
       1, "no URDF"},
  };
  const ScratchFolder folder;
  for (const BadRobot& given : cases) {
    const auto file = folder.write("a.urdf", given.text);
    const Error error = refusal({file, {}, {}});
    EXPECT_EQ(error.where(), (FileLocation{file.string(), given.line})) << error.what();
    EXPECT_THAT(error.what(), HasSubstr(given.words));
  }
}

}  // namespace
}  // namespace tether::sim
