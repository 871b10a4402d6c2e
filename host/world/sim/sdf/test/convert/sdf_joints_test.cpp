#include "uav_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using uav::Vec3;

using SdfJoints = UavModel;

/// A gimbal: arm, then head with a camera, which a mount is fixed to. The joints in the other
/// order.
std::string gimbal(const std::string& more = "") {
  return with(kUav, "</link>",
              R"(</link>
    <link name='arm'><pose>0 0 -0.1 0 0 0</pose></link>
    <link name='head'><pose>0.1 0 -0.2 0 0 0</pose>
      <sensor name='eye2' type='camera'><pose>0.05 0 0 0 0 0</pose>
        <camera><horizontal_fov>1.5</horizontal_fov><image><width>32</width><height>24</height></image>
        <clip><near>0.1</near><far>20</far></clip></camera></sensor></link>
    <joint name='bolt' type='fixed'><parent>head</parent><child>mount</child></joint>
    <joint name='pitch' type='revolute'><parent>arm</parent><child>head</child>
      <axis><xyz>0 1 0</xyz><limit><lower>-0.5</lower><upper>1.5</upper><velocity>2</velocity></limit></axis></joint>
    <joint name='yaw' type='revolute'><parent>body</parent><child>arm</child>
      <axis><xyz>0 0 1</xyz><limit><lower>-1</lower><upper>1</upper><velocity>3</velocity></limit></axis></joint>
    <link name='mount'><pose>0.1 0 -0.3 0 0 0</pose>
      <sensor name='nose2' type='ray'><ray><scan><horizontal><samples>1</samples><resolution>1</resolution>
        <min_angle>0</min_angle><max_angle>0</max_angle></horizontal></scan>
        <range><min>0.1</min><max>5</max></range></ray></sensor></link>)" +
                  more);
}

const Sensor& sensor(const Uav& uav, const std::string& name) {
  for (const Sensor& sensor : uav.sensors)
    if (sensor.name == name) return sensor;
  throw std::out_of_range(name);
}

TEST_F(SdfJoints, WithLimitsAreAChainThatTurnsSensors) {
  EXPECT_THAT(warnings(gimbal()), IsEmpty());
  const Uav uav = read(gimbal());
  ASSERT_THAT(uav.joints, SizeIs(2));
  EXPECT_EQ(uav.joints[0], (uav::Joint{"yaw", {0, 0, -0.1}, {0, 0, 1}, -1, 1, 3}));
  EXPECT_EQ(uav.joints[1], (uav::Joint{"pitch", {0.1, 0, -0.2}, {0, 1, 0}, -0.5, 1.5, 2}));
  EXPECT_EQ(sensor(uav, "eye").joints, 0u);
  EXPECT_EQ(sensor(uav, "eye2").joints, 2u);
  EXPECT_EQ(sensor(uav, "nose2").joints, 2u);
  EXPECT_LT(norm(sensor(uav, "eye2").X_BS.p - Vec3{0.15, 0, -0.2}), 1e-12);
}

// The head of 0.1 kg is turned by 90° about z: its own x lies along the body's y.
TEST_F(SdfJoints, CarryPartsWhoseMassJoinsTheBody) {
  const Uav light = read(gimbal());
  const std::string heavy = with(
      gimbal(), "<link name='head'><pose>0.1 0 -0.2 0 0 0</pose>",
      "<link name='head'><pose>0.1 0 -0.2 0 0 1.5707963267948966</pose><inertial><mass>0.1</mass>"
      "<inertia><ixx>0.001</ixx><iyy>0.002</iyy><izz>0.0025</izz></inertia></inertial>");
  const Uav uav = read(heavy);
  EXPECT_THAT(warnings(heavy), IsEmpty());
  EXPECT_DOUBLE_EQ(uav.airframe.mass_kg, light.airframe.mass_kg + 0.1);
  EXPECT_EQ(uav.body.mass_kg, uav.airframe.mass_kg);
  const Vec3 gained = uav.airframe.inertia_kg_m2 - light.airframe.inertia_kg_m2;
  EXPECT_LT(norm(gained - Vec3{0.002 + 0.1 * 0.04, 0.001 + 0.1 * 0.05, 0.0025 + 0.1 * 0.01}),
            1e-12);
}

TEST_F(SdfJoints, HaveASensorOfTheirAngles) {
  const Uav uav = read(gimbal());
  EXPECT_EQ(uav.sensors.back().name, "joint_state");
  EXPECT_EQ(uav.sensors.back().kind(), uav::SensorKind::kJointState);
  EXPECT_EQ(uav.sensors.back().update_rate_hz, 0.0);
}

TEST_F(SdfJoints, OfOtherKindsAreWarnedOfAndTheirLinksLeftOut) {
  const std::string sensors = gimbal(R"(
    <link name='wheel'/><joint name='axle' type='revolute'><parent>body</parent><child>wheel</child>
      <axis><xyz>0 0 1</xyz></axis></joint>
    <link name='leg'/><joint name='slide' type='prismatic'><parent>body</parent><child>leg</child>
      <axis><xyz>0 0 1</xyz><limit><lower>0</lower><upper>1</upper><velocity>2</velocity></limit></axis></joint>
    <link name='tail'/><joint name='second' type='revolute'><parent>body</parent><child>tail</child>
      <axis><xyz>0 0 1</xyz><limit><lower>0</lower><upper>1</upper><velocity>2</velocity></limit></axis></joint>)");
  EXPECT_THAT(warnings(sensors),
              ElementsAre(HasSubstr("link 'wheel'"), HasSubstr("link 'leg'"),
                          HasSubstr("link 'tail'"), HasSubstr("joint 'axle'"),
                          HasSubstr("joint 'slide'"), HasSubstr("joint 'second'")));
  EXPECT_THAT(read(sensors).joints, SizeIs(2));
}

TEST_F(SdfJoints, TurnNothingThatMeasuresMotion) {
  const std::string model =
      with(gimbal(), "<sensor name='nose2' type='ray'>",
           "<sensor name='imu2' type='imu'/><sensor name='nose2' type='ray'>");
  EXPECT_THAT(warnings(model), ElementsAre(HasSubstr("sensor 'imu2'")));
  EXPECT_THAT(read(model).sensors, SizeIs(5));
}

}  // namespace
}  // namespace tether::sim
