#include "fake_vehicle.h"

#include <gmock/gmock.h>

namespace tether::c_api {
namespace {

tether_setpoint position() {
  tether_setpoint s{};
  s.mask = TETHER_POSITION | TETHER_YAW;
  s.position_W_m = {1, 2, 3};
  s.yaw_rad = 0.5;
  return s;
}

TEST(Commands, EveryFieldArrives) {
  const Flown flown;
  tether_setpoint s{};
  s.after_ns = 7;
  s.mask = 1 + 2 + 4 + 8 + 16 + 32 + 64 + 128 + 256;
  s.in_heading = 1;
  s.position_W_m = {1, 2, 3};
  s.velocity_m_s = {4, 5, 6};
  s.acceleration_m_s2 = {7, 8, 9};
  s.yaw_rad = 10;
  s.yaw_rate_rad_s = 11;
  s.q_WB = {12, 13, 14, 15};
  s.rates_B_rad_s = {16, 17, 18};
  s.thrust_N = 19;
  s.rotor_speeds_rad_s[1] = 20;
  s.rotors = 2;
  s.mask = 1023;
  s.joints_rad[0] = 21;
  s.joints = 1;
  ASSERT_EQ(tether_follow(flown.vehicle, &s, 1, sizeof s), TETHER_OK);
  const uav::Setpoint expected{.mask = 1023,
                               .in_heading = true,
                               .p_WB_m = {1, 2, 3},
                               .velocity_m_s = {4, 5, 6},
                               .acceleration_m_s2 = {7, 8, 9},
                               .yaw_rad = 10,
                               .yaw_rate_rad_s = 11,
                               .q_WB = {12, 13, 14, 15},
                               .w_WB_B_rad_s = {16, 17, 18},
                               .thrust_N = 19,
                               .rotor_speeds_rad_s = {0, 20},
                               .joints_rad = {21}};
  EXPECT_THAT(flown.fake->followed,
              testing::ElementsAre(uav::TimedSetpoint{Duration(7), expected}));
}

TEST(Commands, AListOfAnOlderOrNewerProgramIsReadByItsOwnSize) {
  const Flown flown;
  struct Newer {
    tether_setpoint known;
    double later;
  } list[2] = {{position(), 1}, {position(), 2}};
  list[1].known.after_ns = 5;
  ASSERT_EQ(tether_follow(flown.vehicle, &list[0].known, 2, sizeof list[0]), TETHER_OK);
  ASSERT_EQ(flown.fake->followed.size(), 2u);
  EXPECT_EQ(flown.fake->followed[1].after, Duration(5));
  EXPECT_EQ(flown.fake->followed[1].setpoint.p_WB_m, (uav::Vec3{1, 2, 3}));
}

TEST(Commands, WrongArgumentsAreRefused) {
  const Flown flown;
  tether_setpoint s = position();
  EXPECT_EQ(tether_follow(nullptr, &s, 1, sizeof s), TETHER_INVALID);
  EXPECT_EQ(tether_follow(flown.vehicle, nullptr, 1, sizeof s), TETHER_INVALID);
  EXPECT_EQ(tether_follow(flown.vehicle, &s, 1, 8), TETHER_INVALID);
  EXPECT_EQ(tether_get_flight_limits(flown.vehicle, nullptr, 24), TETHER_INVALID);
  EXPECT_TRUE(flown.fake->followed.empty());

  s.mask = 1u << 16;  // does not become 0
  s.rotors = 1000;
  ASSERT_EQ(tether_follow(flown.vehicle, &s, 1, sizeof s), TETHER_OK);
  EXPECT_NE(complaint_about(flown.fake->followed, uav::FlightLimits{}), "");
  EXPECT_EQ(flown.fake->followed[0].setpoint.rotor_speeds_rad_s.size(), 9u);
}

TEST(Commands, JointsAreThoseOfTheCatalogue) {
  const Flown flown;
  EXPECT_EQ(tether_joint_count(nullptr), 0u);
  EXPECT_EQ(tether_sensor_joints(tether_find_sensor(flown.vehicle, "camera")), 1u);
  EXPECT_EQ(tether_sensor_joints(tether_find_sensor(flown.vehicle, "imu")), 0u);
  EXPECT_EQ(tether_sensor_joints(nullptr), 0u);
  ASSERT_EQ(tether_joint_count(flown.vehicle), 1u);
  tether_joint joint{};
  ASSERT_EQ(tether_get_joint(flown.vehicle, 0, &joint, sizeof joint), TETHER_OK);
  EXPECT_STREQ(joint.name, "yaw");
  EXPECT_EQ(joint.point_B_m.y, 2.0);
  EXPECT_EQ(joint.axis_B.z, 1.0);
  EXPECT_EQ(joint.min_rad, -1.0);
  EXPECT_EQ(joint.max_rad, 2.0);
  EXPECT_EQ(joint.max_rate_rad_s, 0.5);
  EXPECT_EQ(tether_get_joint(flown.vehicle, 1, &joint, sizeof joint), TETHER_INVALID);
  EXPECT_EQ(tether_get_joint(flown.vehicle, 0, nullptr, sizeof joint), TETHER_INVALID);
}

}  // namespace
}  // namespace tether::c_api
