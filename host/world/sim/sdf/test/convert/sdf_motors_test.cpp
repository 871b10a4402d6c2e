#include "uav_folder.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using uav::Vec3;

struct Hub {
  double x_m, y_m;
  const char* turns;
};
constexpr Hub kHubs[] = {
    {0.2, -0.2, "ccw"}, {-0.2, 0.2, "ccw"}, {0.2, 0.2, "cw"}, {-0.2, -0.2, "cw"}};

/// A body of 1.6 kg with four rotor links of 0.1 kg on revolute joints, 0.1 m above it, and a
/// camera on a boom.
std::string frame() {
  std::string links = R"(<link name='base_link'><pose>0 0 0.3 0 0 0</pose>
<inertial><mass>1.6</mass><inertia><ixx>0.02</ixx><iyy>0.02</iyy><izz>0.04</izz></inertia></inertial>
<collision name='hull'><geometry><box><size>0.3 0.3 0.1</size></box></geometry></collision>
<sensor name='imu' type='imu'><update_rate>200</update_rate></sensor></link>
)";
  for (std::size_t i = 0; i < std::size(kHubs); ++i)
    links += fmt::format(
        "<link name='rotor_{0}'><pose>{1} {2} 0.4 0 0 0</pose><inertial><mass>0.1</mass><inertia>"
        "<ixx>1e-5</ixx><iyy>1e-5</iyy><izz>1e-5</izz></inertia></inertial></link>\n"
        "<joint name='joint_{0}' type='revolute'><parent>base_link</parent><child>rotor_{0}</child>"
        "<axis><xyz>0 0 1</xyz></axis></joint>\n",
        i, kHubs[i].x_m, kHubs[i].y_m);
  return links;
}

std::string model(const std::string& content) {
  return "<sdf version='1.9'><model name='drone'>\n" + content + "</model></sdf>";
}

std::string motor(std::size_t i, const std::string& file) {
  return fmt::format(
      "<plugin name='gz::sim::systems::MulticopterMotorModel' filename='{}'>"
      "<jointName>joint_{}</jointName><linkName>rotor_{}</linkName>"
      "<turningDirection>{}</turningDirection><timeConstantUp>0.02</timeConstantUp>"
      "<timeConstantDown>0.03</timeConstantDown><maxRotVelocity>1000</maxRotVelocity>"
      "<motorConstant>1e-5</motorConstant><momentConstant>0.02</momentConstant>"
      "<rotorDragCoefficient>2e-5</rotorDragCoefficient><motorType>velocity</motorType></plugin>\n",
      file, i, i, kHubs[i].turns);
}

std::string with_motor_models(const std::string& file = "gz-sim-multicopter-motor-model-system") {
  std::string content = frame();
  for (std::size_t i = 0; i < std::size(kHubs); ++i) content += motor(i, file);
  return model(content);
}

using SdfMotors = UavModel;

TEST_F(SdfMotors, GiveTheAirframe) {
  const Uav uav = read(with_motor_models());
  const uav::MultirotorParameters& airframe = uav.airframe;
  ASSERT_EQ(airframe.rotors.size(), 4u);
  EXPECT_EQ(airframe.rotors[0].direction, 1);
  EXPECT_EQ(airframe.rotors[3].direction, -1);
  EXPECT_EQ(airframe.thrust_coefficient, 1e-5);
  EXPECT_EQ(airframe.moment_coefficient_m, 0.02);
  EXPECT_EQ(airframe.max_rotor_speed_rad_s, 1000.0);
  EXPECT_EQ(airframe.time_constant_up_s, 0.02);
  EXPECT_EQ(airframe.time_constant_down_s, 0.03);
  EXPECT_EQ(airframe.drag_coefficient, 2e-5);
  EXPECT_THAT(uav.by_default,
              ElementsAre("linear_drag_N_s_per_m", "max_tilt_rad", "max_horizontal_speed_m_s",
                          "max_vertical_speed_m_s", "max_yaw_rate_rad_s"));
  EXPECT_EQ(airframe.max_tilt_rad, uav::hummingbird().max_tilt_rad);
  for (const char* kin : {"libgazebo_motor_model.so", "librotors_gazebo_motor_model.so"})
    EXPECT_EQ(read(with_motor_models(kin)).airframe.rotors.size(), 4u) << kin;
}

// 4 × 0.1 kg, 0.1 m above 1.6 kg: 0.02 m above the body's origin.
TEST_F(SdfMotors, TurnLinksThatWeighTheirOwn) {
  const Uav uav = read(with_motor_models());
  EXPECT_DOUBLE_EQ(uav.airframe.mass_kg, 2.0);
  const double lever = 1.6 * 0.02 * 0.02 + 4 * 0.1 * 0.08 * 0.08;
  EXPECT_NEAR(uav.airframe.inertia_kg_m2.x, 0.02 + 4 * (1e-5 + 0.1 * 0.04) + lever, 1e-12);
  EXPECT_NEAR(uav.airframe.inertia_kg_m2.z, 0.04 + 4 * (1e-5 + 0.1 * 0.08), 1e-12);
  EXPECT_NEAR(norm(uav.airframe.rotors[0].p_BR - Vec3{0.2, -0.2, 0.08}), 0.0, 1e-12);
  ASSERT_EQ(uav.sensors.size(), 1u);
  EXPECT_NEAR(norm(uav.sensors[0].X_BS.p - Vec3{0, 0, -0.02}), 0.0, 1e-12);
  EXPECT_NEAR(uav.body.collisions.at(0).X_LC.p.z, -0.02, 1e-12);
  EXPECT_THAT(warnings(with_motor_models()), Not(Contains(HasSubstr("joint"))));
}

// A rotor's joint with limits is still no gimbal.
TEST_F(SdfMotors, LeaveJointsThatProgramsTurn) {
  const std::string limits =
      "<limit><lower>-1</lower><upper>1</upper><velocity>2</velocity></limit></axis></joint>\n";
  const std::string uav_file =
      with(with(with_motor_models(), "<axis><xyz>0 0 1</xyz></axis></joint>\n",
                "<axis><xyz>0 0 1</xyz>" + limits),
           "</model>",
           "<link name='head'><pose>0.1 0 0.2 0 0 0</pose><inertial><mass>0.1</mass><inertia>"
           "<ixx>1e-5</ixx><iyy>1e-5</iyy><izz>1e-5</izz></inertia></inertial>"
           "<sensor name='nose' type='ray'><ray><scan><horizontal><samples>1</samples>"
           "<resolution>1</resolution><min_angle>0</min_angle><max_angle>0</max_angle></horizontal>"
           "</scan><range><min>0.1</min><max>5</max></range></ray></sensor></link>"
           "<joint name='tilt' type='revolute'><parent>base_link</parent><child>head</child>"
           "<axis><xyz>0 1 0</xyz>" +
               limits + "</model>");
  const Uav uav = read(uav_file);
  EXPECT_DOUBLE_EQ(uav.airframe.mass_kg, 2.1);
  ASSERT_EQ(uav.joints.size(), 1u);
  EXPECT_EQ(uav.joints[0].name, "tilt");
  ASSERT_EQ(uav.sensors.size(), 3u) << "with that of the joints";
  EXPECT_EQ(uav.sensors[0].joints, 0u) << uav.sensors[0].name;
  EXPECT_EQ(uav.sensors[1].joints, 1u) << uav.sensors[1].name;
  EXPECT_LT(norm(uav.joints[0].p_BJ - uav.sensors[1].X_BS.p), 1e-12);
  EXPECT_THAT(warnings(uav_file), Not(Contains(HasSubstr("joint"))));
}

// As PX4's models do it: each lidar has a sensor of one name.
TEST_F(SdfMotors, NestedModelsHaveSensorsOfTheirOwn) {
  const std::string file =
      with(with_motor_models(), "</model>",
           "<model name='box'><link name='l'><sensor name='imu' type='imu'/></link></model>"
           "<joint name='fix' type='fixed'><parent>base_link</parent><child>box::l</child></joint>"
           "</model>");
  const Uav uav = read(file);
  ASSERT_EQ(uav.sensors.size(), 2u);
  EXPECT_EQ(uav.sensors[0].name, "imu");
  EXPECT_EQ(uav.sensors[1].name, "box_imu");
  EXPECT_THAT(warnings(file), Contains(HasSubstr("its name is 'box_imu'")));
}

/// Rotors of ArduPilot's models: two blades each, and in a model that is nested.
std::string with_channels(const std::string& cp = "0.1 0 0") {
  std::string content = "<model name='inner'>" + frame() + "</model>\n";
  std::string channels;
  for (std::size_t i = 0; i < std::size(kHubs); ++i) {
    for (const std::string& at : {cp, "-" + cp})
      content += fmt::format(
          "<plugin name='gz::sim::systems::LiftDrag' "
          "filename='gz-sim-lift-drag-system'><a0>0.3</a0>"
          "<cla>4</cla><cda>0.1</cda><area>0.002</area><air_density>1.2</air_density><cp>{}</cp>"
          "<link_name>inner::rotor_{}</link_name></plugin>\n",
          at, i);
    channels += fmt::format(
        "<control channel='{}'><jointName>inner::joint_{}</jointName><multiplier>{}</multiplier>"
        "<type>VELOCITY</type></control>\n",
        i, i, kHubs[i].turns == std::string("ccw") ? 800 : -800);
  }
  return model(content + "<plugin name='ArduPilotPlugin' filename='ArduPilotPlugin'>" + channels +
               "<control channel='4'><jointName>gimbal</jointName><type>COMMAND</type></control>"
               "</plugin>\n");
}

// A blade: ½ · 1.2 kg/m³ · (0.1 m)² · 0.002 m² · 4 · 0.3.
TEST_F(SdfMotors, OfArduPilotPushByTheirBlades) {
  const Uav uav = read(with_channels());
  EXPECT_NEAR(uav.airframe.thrust_coefficient, 2 * 1.44e-5, 1e-12);
  EXPECT_NEAR(uav.airframe.moment_coefficient_m, 0.1 * 0.1 / 4, 1e-12);
  EXPECT_EQ(uav.airframe.max_rotor_speed_rad_s, 800.0);
  ASSERT_EQ(uav.airframe.rotors.size(), 4u);
  EXPECT_EQ(uav.airframe.rotors[1].direction, 1);
  EXPECT_EQ(uav.airframe.rotors[2].direction, -1);
  EXPECT_DOUBLE_EQ(uav.airframe.mass_kg, 2.0);
  EXPECT_THAT(uav.by_default, Contains("time_constant_up_s"));
}

TEST_F(SdfMotors, ThatTheModelCannotFlyWithAreRefused) {
  const auto message = [&](const std::string& text) {
    return std::string(refusal(request(text)).what());
  };
  const std::string good = with_motor_models();
  const auto changed = [&](const char* from, const char* to) {
    return message(with(good, from, to));
  };
  EXPECT_THAT(changed("<maxRotVelocity>1000</maxRotVelocity>", ""), HasSubstr("<maxRotVelocity>"));
  EXPECT_THAT(changed("<motorConstant>1e-5", "<motorConstant>2e-5"), HasSubstr("must be alike"));
  EXPECT_THAT(changed("<turningDirection>ccw", "<turningDirection>left"), HasSubstr("cw or ccw"));
  EXPECT_THAT(changed("<linkName>rotor_0", "<linkName>rotor_9"), HasSubstr("'rotor_9'"));
  EXPECT_THAT(changed("0.2 -0.2 0.4 0 0 0", "0.2 -0.2 0.4 0 1.57 0"), HasSubstr("push up"));
  EXPECT_THAT(changed("<motorType>velocity", "<motorType>position"), HasSubstr("<motorType>"));
  EXPECT_THAT(message(with_channels("0 0 0.1")), HasSubstr("<tether:multirotor>"));
  EXPECT_THAT(message(model(frame())), HasSubstr("MulticopterMotorModel"));
}

}  // namespace
}  // namespace tether::sim
