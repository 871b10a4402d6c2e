#include "uav_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using uav::Vec3;

using SdfUav = UavModel;

TEST_F(SdfUav, MergesFixedLinksAndLeavesOutMovingOnes) {
  const std::string model = with(kUav, "</link>", R"(</link>
      <link name='mast'/>
      <joint name='bolt' type='fixed'><parent>body</parent><child>mast</child></joint>
      <link name='arm'><pose>0 0 1 0 0 0</pose><inertial><mass>0.1</mass></inertial>
        <visual name='v'><geometry><sphere><radius>0.1</radius></sphere></geometry></visual>
        <sensor name='imu' type='imu'><pose>0 1 0 0 0 0</pose></sensor></link>
      <link name='wheel'/>
      <joint name='weld' type='fixed'><parent>body</parent><child>arm</child></joint>
      <joint name='axle' type='revolute'><parent>body</parent><child>wheel</child>
        <axis><xyz>0 0 1</xyz></axis></joint>)");
  EXPECT_THAT(warnings(model), ElementsAre(HasSubstr("link 'arm'"), HasSubstr("link 'wheel'"),
                                           HasSubstr("joint 'axle'")));
  const Uav uav = read(model);
  ASSERT_EQ(uav.body.visuals.size(), 1u);
  EXPECT_EQ(uav.body.visuals[0].X_LV.p, (Vec3{0, 0, 1}));
  EXPECT_EQ(uav.sensors.at(2).X_BS.p, (Vec3{0, 1, 1}));
}

using BadUavFiles = BadUavs;

TEST_F(BadUavFiles, AreRefused) {
  expect_error(refusal(request(world_sdf(""))), folder_.path("uav.sdf"), 0, "<model>");
  expect_refused({{"name='nose'", "name='eye'", 22, ""}});
}

}  // namespace
}  // namespace tether::sim
