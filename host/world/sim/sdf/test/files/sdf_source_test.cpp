#include "files/sdf_source.h"

#include "files/sdf_numbers.h"
#include "sdf_folder.h"

#include <new>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

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

std::size_t descriptions_of(const sdf::Element& element) {
  std::size_t count = 1;
  for (unsigned i = 0; i < element.GetElementDescriptionCount(); ++i)
    count += descriptions_of(*element.GetElementDescription(i));
  return count;
}

// libsdformat copies the description of each element: a world of 3000 models had 8 GB of them.
TEST(SdfSource, AModelHasFewDescriptionsOfWhatItsFileDoesNotName) {
  const ScratchFolder folder;
  const SdfSource source(folder.write("w.sdf", world_sdf(R"(
      <model name='m'><link name='l'><collision name='c'><geometry><box><size>1 1 1</size></box>
      </geometry></collision></link></model>)")),
                         {}, {});
  const sdf::ElementPtr model = source.element()->GetElement("world")->FindElement("model");
  EXPECT_LT(descriptions_of(*model), 100U);
  EXPECT_GT(descriptions_of(*sdf_description()), 5000U);
}

// Gazebo saves nested models so, and libsdformat's converter gives up on the empty frame.
TEST(SdfSource, ReadsNamesOfNestedModelsWithEmptyFrames) {
  const Loaded loaded = load_content(R"(<model name='m'><static>1</static>
      <link name='a::b'><pose frame=''>1 0 0 0 0 0</pose>
        <collision name='c'><pose frame="">0 2 0 0 0 0</pose>
          <geometry><box><size>1 1 1</size></box></geometry></collision></link></model>)");
  ASSERT_EQ(loaded.world.models.size(), 2u);
  EXPECT_EQ(loaded.world.models[1].name, "m::a");
  EXPECT_EQ(loaded.world.models[1].links.at(0).collisions.at(0).X_LC.p, (Vec3{0, 2, 0}));
}

TEST(SdfSource, RefusesWhatMakesTheLibraryThrow) {
  const ScratchFolder folder;
  const auto file = folder.write("w.sdf", world_sdf("<model name='m'><static>1</static>\n"
                                                    "<link name='::'><pose relative_to='x'>"
                                                    "1 0 0 0 0 0</pose></link></model>"));
  const Error error = refusal({file, {}, {}});
  EXPECT_EQ(error.where(), (FileLocation{file.string(), 4}));
  EXPECT_THAT(error.what(), ::testing::HasSubstr("libsdformat cannot read it"));
  const auto throwing = [](const auto& exception) {
    return bad_file_error([&] { ask_library({"f.sdf"}, [&]() -> int { throw exception; }); });
  };
  EXPECT_THAT(throwing(sdf::AssertionInternalError("f", 1, "a == b", "g", "wrong")).what(),
              ::testing::HasSubstr("f.sdf: libsdformat cannot read it ("));
  EXPECT_THROW(ask_library({"f.sdf"}, []() -> int { throw std::bad_alloc(); }), std::bad_alloc);
}

TEST(SdfSource, GoesWithoutWhatHasAValueThatSdfDoesNotAllowUnlessStrict) {
  const ScratchFolder folder;
  const auto file = folder.write(
      "w.sdf", world_sdf("<model name='m'><static>1</static><link name='l'>\n"
                         "<sensor name='eye' type='camera'><camera>\n"
                         "<horizontal_fov>0.05</horizontal_fov></camera></sensor>\n"
                         "<visual name='v'><geometry><box>"
                         "<size>1 1 1</size></box></geometry></visual></link></model>\n"
                         "<light name='sun' type='directional'/>"));
  EXPECT_THAT(refusal({file, {}, {}}).what(), ::testing::HasSubstr("'0.05'"));
  const Loaded loaded = load({file, {}, {}});
  EXPECT_THAT(loaded.warnings,
              ::testing::ElementsAre(is_warning(Consequence::kMissing, file, 5, "sensor 'eye'")));
  EXPECT_EQ(loaded.world.lights.size(), 1u);
}

TEST(SdfSource, PrintsNothing) {
  const ScratchFolder folder;
  const auto bad = folder.write("w.sdf", link_sdf("<inertial><mass>heavy</mass></inertial>"));
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  refusal({bad, {}, {}});
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

TEST(SdfSource, RefusesMissingFilesAndDirectories) {
  const ScratchFolder folder;
  const auto world = folder.write("w.sdf", world_sdf(""));
  expect_error(refusal({"/nowhere/w.sdf", {}, {}}), "/nowhere/w.sdf", 0, "");
  expect_error(refusal({folder.path(), {}, {}}), folder.path(), 0, "");
  expect_error(refusal({world, {{"uav", folder.path(), {}, 0.0}}, {}}), folder.path(), 0, "");
}

TEST(SdfSource, ReportsErrorsInTheIncludedFile) {
  const ScratchFolder folder;
  folder.write("models/thing/model.config",
               "<model><name>thing</name><sdf version='1.7'>model.sdf</sdf></model>");
  const auto file = folder.write("w.sdf", world_sdf("<include><uri>model://thing</uri></include>"));
  const auto expect_refused = [&](const std::string& content, const std::string& subject) {
    const auto inner = folder.write("models/thing/model.sdf",
                                    "<sdf version='1.7'>\n<model name='thing'><link name='l'>\n" +
                                        content + "</link></model></sdf>");
    expect_error(refusal({file, {}, {}}), inner, 3, subject);
  };
  expect_refused("<inertial><mass>1 kg</mass></inertial>", "<mass> of link 'l'");
  expect_refused(
      "<visual name='v'><geometry><sphere><radius>-1</radius></sphere></geometry></visual>",
      "<radius> of visual 'v'");
}

}  // namespace
}  // namespace tether::sim
