#include "files/sdf_repair.h"

#include "sdf_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(SdfRepair, CloudsMayBlowFromTheOtherSide) {
  const Loaded loaded =
      load_content("<scene><sky><clouds><speed>-4</speed></clouds></sky></scene>");
  EXPECT_THAT(loaded.warnings,
              ElementsAre(::testing::Field(&Warning::subject, "<sky> of world 'w'")));
}

TEST(SdfRepair, ScriptsOfMaterialsNeedNoUri) {
  for (const char* uri : {"", "<uri/>", "<uri>__default__</uri>"}) {
    const Loaded loaded = load_content(
        "<model name='m'><static>true</static><link name='l'><visual name='v'><geometry><box>"
        "<size>1 1 1</size></box></geometry><material><script>" +
        std::string(uri) + "<name>Gazebo/Red</name></script></material></visual></link></model>");
    EXPECT_THAT(loaded.warnings, IsEmpty());
    EXPECT_EQ(loaded.world.models.at(0).links.at(0).visuals.at(0).material.diffuse_rgb,
              (uav::Vec3{1.0, 0.0, 0.0}));
  }
}

TEST(SdfRepair, AModelMayBeEmpty) {
  const Loaded loaded = load_content(
      "<model name='m'><pose>1 2 3 0 0 0</pose></model><model name='n'><link name='l'><visual "
      "name='v'><geometry><box><size>1 1 1</size></box></geometry><material><script><uri>a</uri>"
      "</script></material></visual></link></model>");
  EXPECT_THAT(loaded.warnings, IsEmpty());
  EXPECT_TRUE(loaded.world.models.at(0).is_static);
  EXPECT_FALSE(loaded.world.models.at(1).is_static);
}

TEST(SdfRepair, AWorldMayBeCalledWorld) {
  const ScratchFolder folder;
  const auto file = folder.write("w.sdf", "<sdf version='1.7'><world name='world'/></sdf>");
  EXPECT_EQ(load({file, {}, {}}).world.name, "world_");
}

TEST(SdfRepair, OtherPlanetsAreMeasuredAsEarth) {
  const Loaded loaded = load_content(
      "<spherical_coordinates><surface_model>MOON_SCS</surface_model></spherical_coordinates>");
  EXPECT_TRUE(loaded.world.place);
  EXPECT_THAT(loaded.warnings, ElementsAre(::testing::Field(&Warning::subject, "<surface_model>")));
}

}  // namespace
}  // namespace tether::sim
