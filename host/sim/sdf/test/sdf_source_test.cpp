#include "sdf_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using uav::Vec3;

TEST(SdfSource, FindsIncludesByModelUriAndRelativeToTheFile) {
  const ScratchFolder folder;
  folder.write("models/thing/model.config",
               "<model><name>thing</name><sdf version='1.7'>model.sdf</sdf></model>");
  folder.write("models/thing/mesh.stl", "solid");
  folder.write("models/thing/model.sdf", R"(<sdf version='1.7'><model name='thing'><link name='l'>
      <visual name='v'><geometry><mesh><uri>mesh.stl</uri><scale>2 2 2</scale></mesh></geometry></visual>
      </link></model></sdf>)");
  const auto loaded = load({folder.write("worlds/w.sdf", world_sdf(R"(
      <include><uri>model://thing</uri><name>a</name><pose>1 0 0 0 0 0</pose></include>
      <include><uri>../models/thing</uri><name>b</name><static>true</static></include>)")),
                            {},
                            {}});
  EXPECT_THAT(loaded.warnings, IsEmpty());
  ASSERT_EQ(loaded.world.models.size(), 2u);
  EXPECT_EQ(loaded.world.models[0].name, "a");
  EXPECT_EQ(loaded.world.models[0].X_WM.p, (Vec3{1, 0, 0}));
  EXPECT_TRUE(loaded.world.models[1].is_static);
  const auto& mesh =
      std::get<MeshGeometry>(loaded.world.models[1].links.at(0).visuals.at(0).geometry);
  EXPECT_TRUE(std::filesystem::exists(mesh.file));
  EXPECT_EQ(mesh.scale, (Vec3{2, 2, 2}));
}

TEST(SdfSource, LeavesTheConsoleAlone) {
  const ScratchFolder folder;
  const auto bad = folder.write("w.sdf", link_sdf("<inertial><mass>heavy</mass></inertial>"));
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  EXPECT_NE(refusal({bad, {}, {}}), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

TEST(SdfSource, MissingFileIsNamed) {
  EXPECT_EQ(refusal({"/nowhere/w.sdf", {}, {}}), "/nowhere/w.sdf: there is no such file");
}

TEST(SdfSource, DirectoryIsCalledOne) {
  const ScratchFolder folder;
  const auto world = folder.write("w.sdf", world_sdf(""));
  const std::string message =
      world.parent_path().string() + ": is a directory; name the SDF file in it, such as model.sdf";
  EXPECT_EQ(refusal({world.parent_path(), {}, {}}), message);
  EXPECT_EQ(refusal({world, {{"uav", world.parent_path(), {}, 0.0}}, {}}), message);
}

TEST(SdfSource, UnitInAnIncludedFileNamesThatFile) {
  const ScratchFolder folder;
  folder.write("models/thing/model.config",
               "<model><name>thing</name><sdf version='1.7'>model.sdf</sdf></model>");
  const auto inner = folder.write("models/thing/model.sdf",
                                  "<sdf version='1.7'>\n<model name='thing'><link name='l'>\n"
                                  "<inertial><mass>1 kg</mass></inertial></link></model></sdf>");
  const auto file = folder.write("w.sdf", world_sdf("<include><uri>model://thing</uri></include>"));
  EXPECT_THAT(refusal({file, {}, {}}),
              HasSubstr(inner.string() + ":3: <mass> of link 'l' is '1 kg'"));
}

TEST(SdfSource, ErrorInAnIncludedFileNamesThatFile) {
  const ScratchFolder folder;
  folder.write("models/thing/model.config",
               "<model><name>thing</name><sdf version='1.7'>model.sdf</sdf></model>");
  const auto inner = folder.write("models/thing/model.sdf",
                                  "<sdf version='1.7'>\n<model name='thing'><link name='l'>\n"
                                  "<visual name='v'><geometry><sphere>\n<radius>-1</radius>\n"
                                  "</sphere></geometry></visual></link></model></sdf>");
  const auto file = folder.write("w.sdf", world_sdf("<include><uri>model://thing</uri></include>"));
  EXPECT_THAT(refusal({file, {}, {}}), HasSubstr(inner.string() + ":4: <radius>"));
}

}  // namespace
}  // namespace tether::sim
