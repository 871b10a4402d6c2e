#include "sdf_folder.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// What is mended of a world: names that occur twice in included files, and impossible inertias.
namespace tether::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using uav::Vec3;

constexpr Consequence kRenamed = Consequence::kNoEffect;

TEST(SdfMend, NumbersNamesThatOccurTwiceInIncludedFiles) {
  const ScratchFolder folder;
  const std::string shape = "<geometry><sphere><radius>1</radius></sphere></geometry>";
  const auto inner =
      folder.write("inner.sdf", R"(<sdf version='1.7'><model name='a'><static>1</static>
      <link name='l'><visual name='v'>)" +
                                    shape + "</visual>\n<visual name='v'>" + shape +
                                    "</visual></link>\n<link name='l'/>\n"
                                    "<frame name='l'/></model></sdf>");
  const std::string include = "<include><uri>inner.sdf</uri></include>\n";
  const auto file = folder.write("w.sdf", world_sdf(include + include));
  const Loaded loaded = load({file, {}, {}});
  ASSERT_EQ(loaded.world.models.size(), 2u);
  EXPECT_EQ(loaded.world.models[1].name, "a_1");
  ASSERT_EQ(loaded.world.models[0].links.size(), 2u);
  EXPECT_EQ(loaded.world.models[0].links[1].name, "l_1");
  EXPECT_EQ(loaded.world.models[0].links[0].visuals.at(1).name, "v_1");
  EXPECT_THAT(loaded.warnings, ::testing::Contains(is_warning(kRenamed, inner, 3, "visual 'v'")));
}

TEST(SdfMend, LeavesNamesOfTheWorldItselfToTheUser) {
  const ScratchFolder folder;
  const auto file = folder.write("w.sdf", world_sdf("<model name='a'><link name='l'/></model>\n"
                                                    "<model name='a'><link name='l'/></model>"));
  EXPECT_EQ(refusal({file, {}, {}}).where().file, file.string());
}

/// Two models whose links have the same name: the inertia of the second, on line 5, is given.
std::string world_of(const std::string& inertia) {
  return world_sdf(
      "<model name='a'><link name='link'/></model>\n"
      "<model name='b'><link name='link'><inertial><mass>2</mass>\n<inertia>" +
      inertia + "</inertia></inertial></link></model>");
}

TEST(SdfMend, RefusesImpossibleInertiasUnlessTolerant) {
  const ScratchFolder folder;
  for (const char* inertia : {"<ixx>1</ixx><iyy>1</iyy><izz>2.5</izz>", "<ixx>0</ixx>",
                              "<ixx>1</ixx><iyy>-1</iyy><izz>1</izz>",
                              "<ixx>1</ixx><iyy>1</iyy><izz>1</izz><ixy>3</ixy>"}) {
    SCOPED_TRACE(inertia);
    const auto file = folder.write("w.sdf", world_of(inertia));
    const Error error = refusal({file, {}, {}});
    expect_error(error, file, 5, "<inertia> of link 'link'");
    EXPECT_THAT(error.what(), ::testing::HasSubstr("in model 'b'"));

    const Loaded loaded = load({file, {}, {}, {}, {.is_tolerant = true}});
    EXPECT_THAT(loaded.warnings, ElementsAre(is_warning(Consequence::kBehavesDifferent, file, 5,
                                                        "<inertia> of link 'link'")));
    const Vec3 moments = loaded.world.models.at(1).links.at(0).inertia_kg_m2;
    EXPECT_GT(std::min({moments.x, moments.y, moments.z}), 0.0);
    EXPECT_LE(std::max({moments.x, moments.y, moments.z}),
              0.5 * (moments.x + moments.y + moments.z));
  }
}

// libsdformat's own setter keeps six digits: less than what is added because of rounding.
TEST(SdfMend, KeepsEveryDigitOfWhatItAdds) {
  const ScratchFolder folder;
  const auto file =
      folder.write("w.sdf", world_of("<ixx>0.0347563</ixx><iyy>0.0458929</iyy><izz>0.0977</izz>"));
  const Loaded loaded = load({file, {}, {}, {}, {.is_tolerant = true}});
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_THAT(loaded.warnings[0].message, ::testing::HasSubstr("0.0347563 0.0458929 0.0977"));
  const Vec3 moments = loaded.world.models.at(1).links.at(0).inertia_kg_m2;
  EXPECT_LT(std::max({moments.x, moments.y, moments.z}), 0.5 * (moments.x + moments.y + moments.z));
}

TEST(SdfMend, ChangesNoMoreThanNeeded) {
  const ScratchFolder folder;
  const auto file = folder.write("w.sdf", world_of("<ixx>1</ixx><iyy>1</iyy><izz>2.5</izz>"));
  const Vec3 moments =
      load({file, {}, {}, {}, {.is_tolerant = true}}).world.models.at(1).links.at(0).inertia_kg_m2;
  EXPECT_NEAR(moments.x, 1.5, 1e-5);
  EXPECT_NEAR(moments.z, 3.0, 1e-5);
}

TEST(SdfMend, IgnoresInertiasOfWhatCannotMove) {
  EXPECT_THAT(load_content("<model name='m'><static>true</static><link name='l'><inertial><mass>0"
                           "</mass><inertia><ixx>0</ixx></inertia></inertial></link></model>")
                  .warnings,
              IsEmpty());
}

}  // namespace
}  // namespace tether::sim
