#include "files/sdf_numbers.h"

#include "sdf_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// What must be accepted; bad_world_test.cpp has what is refused.
namespace tether::sim {
namespace {

using ::testing::ElementsAre;

TEST(ParseNumbers, TakesTheWholeTextOrNothing) {
  EXPECT_THAT(*parse_numbers(" +1 -2.5e-3\n.5 "), ElementsAre(1.0, -0.0025, 0.5));
  EXPECT_THAT(*parse_numbers(""), ElementsAre());
  for (const char* text : {"1 kg", "1kg", "1,5", "0x10", "--1", "+-1", "+", "1e", "1e400"}) {
    EXPECT_FALSE(parse_numbers(text).has_value()) << text;
  }
}

TEST(CheckNumbers, AcceptsEveryWayOfWritingANumber) {
  load_content(R"(
      <model name='m'>
        <pose relative_to='world'/>
        <link name='l'>
          <pose rotation_format='quat_xyzw'>0 0 1 0 0 .707 .707</pose>
          <inertial><mass> +1e0 <!-- kilograms --> </mass></inertial>
          <visual name='v'><pose degrees='true'>0 0 1
            0 0 90</pose><geometry><box><size>1. .5 1E-1</size></box></geometry>
            <material><diffuse>1 0 0</diffuse><ambient>1 0 0 1</ambient></material></visual>
          <collision name='c'><geometry><empty/></geometry>
            <surface><contact><collide_bitmask>0xFF</collide_bitmask></contact></surface>
          </collision>
        </link>
        <link name='k'/>
        <joint name='j' type='revolute'><parent>l</parent><child>k</child>
          <axis><xyz>0 0 1</xyz><limit><lower>-inf</lower><upper>1e16</upper></limit></axis></joint>
      </model>)");
}

TEST(CheckNumbers, IgnoresPluginsAndCustomElements) {
  load_content(R"(
      <plugin name='p' filename='libp.so'><mass>1 kg</mass><pose>here</pose></plugin>
      <other:thing xmlns:other='o'><mass>1 kg</mass></other:thing>)");
}

}  // namespace
}  // namespace tether::sim
