#include "uav_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using uav::Vec3;

using SdfUav = UavModel;

TEST_F(SdfUav, FixedLinksAreMergedAndMovingOnesLeftOut) {
  const std::string model = with(kUav, "</link>", R"(</link>
      <link name='arm'><pose>0 0 1 0 0 0</pose>
        <visual name='v'><geometry><sphere><radius>0.1</radius></sphere></geometry></visual>
        <sensor name='imu' type='imu'><pose>0 1 0 0 0 0</pose></sensor></link>
      <link name='wheel'/>
      <joint name='weld' type='fixed'><parent>body</parent><child>arm</child></joint>
      <joint name='axle' type='revolute'><parent>body</parent><child>wheel</child>
        <axis><xyz>0 0 1</xyz></axis></joint>)");
  EXPECT_THAT(warnings(model),
              ElementsAre(HasSubstr("link 'arm' is merged into link 'body'"),
                          HasSubstr("link 'wheel' is not fixed to link 'body'; left out"),
                          HasSubstr("joint 'axle' can move")));
  const Uav uav = read(model);
  ASSERT_EQ(uav.body.visuals.size(), 1u);
  EXPECT_EQ(uav.body.visuals[0].X_LV.p, (Vec3{0, 0, 1}));
  EXPECT_EQ(uav.sensors.at(2).X_BS.p, (Vec3{0, 1, 1}));
}

TEST_F(SdfUav, AWorldIsNoUav) {
  EXPECT_THAT(refusal(request(world_sdf(""))), HasSubstr("uav.sdf: has no <model>"));
}

class BadUavFiles : public BadUavs {};

TEST_P(BadUavFiles, IsRefusedWithFileAndLine) {
  expect_refusal();
}

const BadUav kBadUavFiles[] = {
    {"two_sensors_of_one_name", "name='nose'", "name='eye'", "uav.sdf", "eye"},
};

INSTANTIATE_TEST_SUITE_P(Uavs, BadUavFiles, ::testing::ValuesIn(kBadUavFiles),
                         [](const auto& given) { return given.param.name; });

}  // namespace
}  // namespace tether::sim
