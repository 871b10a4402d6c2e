#include <cmath>
#include <functional>
#include <limits>

#include <gmock/gmock.h>

#include <tether/uav/multirotor.h>
#include <tether/uav/setpoint.h>

namespace tether::uav {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

const FlightLimits kLimits{.rotors = 4, .max_rotor_speed_rad_s = 800, .max_thrust_N = 20};

TEST(Setpoint, OnlyTheDocumentedMasksHaveALevel) {
  int known = 0;
  for (int mask = 0; mask < 1024; ++mask)
    known += level_of(static_cast<std::uint16_t>(mask)).has_value();
  EXPECT_EQ(known, 2 * (6 * 3 + 3)) << "each with and without joints";
  EXPECT_EQ(level_of(kPosition | kVelocity | kYaw), SetpointLevel::kPosition);
  EXPECT_EQ(level_of(kVelocity | kAcceleration | kYawRate), SetpointLevel::kVelocity);
  EXPECT_EQ(level_of(kAcceleration), SetpointLevel::kAcceleration);
  EXPECT_EQ(level_of(kAttitude | kThrust), SetpointLevel::kAttitude);
  EXPECT_EQ(level_of(kBodyRates | kThrust), SetpointLevel::kBodyRates);
  EXPECT_EQ(level_of(kRotorSpeeds), SetpointLevel::kRotors);
  for (const int mask : {0, kYaw + kYawRate + kVelocity, kYaw + 0, kAttitude + 0, kThrust + 0,
                         kPosition + kAcceleration, kRotorSpeeds + kYaw, kAttitude + kBodyRates,
                         kAttitude + kThrust + kYaw})
    EXPECT_EQ(level_of(static_cast<std::uint16_t>(mask)), std::nullopt) << mask;
}

TEST(Setpoint, RefusesWhatNoUavCanFlyAndNamesIt) {
  using testing::HasSubstr;
  const std::vector<std::pair<Setpoint, std::string>> bad = {
      {{.mask = 3 << 14}, "the mask 49152 is no set-point: unknown fields"},
      {{.mask = kYaw}, "the mask 8 is no set-point: yaw. Give a position"},
      {{.mask = kVelocity | kYaw | kYawRate},
       "velocity + yaw + yaw rate. Give a yaw or a yaw rate, not"},
      {{.mask = kPosition}, "world frame"},
      {{.mask = kPosition, .in_heading = false, .p_WB_m = {0, 0, 1.1e5}}, "position"},
      {{.velocity_m_s = {kNan, 0, 0}}, "velocity"},
      {{.velocity_m_s = {0, -100.1, 0}}, "velocity"},
      {{.yaw_rate_rad_s = kInf}, "yaw rate"},
      {{.mask = kAcceleration, .acceleration_m_s2 = {0, 0, -kInf}}, "acceleration"},
      {{.mask = kAttitude | kThrust, .q_WB = {1, 0.1, 0, 0}}, "unit quaternion"},
      {{.mask = kAttitude | kThrust, .q_WB = {kNan, 0, 0, 0}}, "attitude"},
      {{.mask = kAttitude | kThrust, .thrust_N = -1}, "thrust is negative"},
      {{.mask = kAttitude | kThrust, .thrust_N = 21}, "above 20 N"},
      {{.mask = kBodyRates | kThrust, .w_WB_B_rad_s = {0, kNan, 0}}, "body rates"},
      {{.mask = kRotorSpeeds, .rotor_speeds_rad_s = {1, 1, 1}}, "3 rotor speeds"},
      {{.mask = kRotorSpeeds, .rotor_speeds_rad_s = {1, 1, 1, -1}}, "negative"},
      {{.mask = kRotorSpeeds, .rotor_speeds_rad_s = {1, 1, kNan, 1}}, "rotor speeds"},
      {{.mask = kRotorSpeeds, .rotor_speeds_rad_s = {1, 1, 801, 1}}, "above 800 rad/s"}};
  for (const auto& [setpoint, complaint] : bad)
    EXPECT_THAT(complaint_about(setpoint, kLimits), HasSubstr(complaint));
}

TEST(Setpoint, OfJointsHasAnAngleWithinTheLimitsForEachOfThem) {
  using testing::HasSubstr;
  FlightLimits limits;  // of a vehicle that only takes velocities in the heading frame
  limits.joints = {{"yaw", {}, {0, 0, 1}, -1, 1, 2}, {"pitch", {}, {0, 1, 0}, -0.5, 1.5, 2}};
  const auto complaint = [&](std::uint16_t mask, std::vector<double> angles_rad) {
    return complaint_about({.mask = mask, .joints_rad = std::move(angles_rad)}, limits);
  };
  EXPECT_EQ(complaint(kJoints, {-1, 1.5}), "");
  EXPECT_EQ(complaint(kJoints | kVelocity, {0, 0}), "");
  EXPECT_THAT(complaint(kJoints, {0}), HasSubstr("1 joint angles, but the UAV has 2"));
  EXPECT_EQ(complaint_about({.mask = kJoints}, FlightLimits{}), "the UAV has no joints");
  EXPECT_THAT(complaint(kJoints, {0, kNan}), HasSubstr("joint angles must be finite"));
  EXPECT_THAT(complaint(kJoints, {0, 1.6}), HasSubstr("'pitch' is not within -0.5..1.5 rad"));
  EXPECT_THAT(complaint(kJoints | kPosition, {0, 0}), HasSubstr("world frame"));
  const Setpoint alone{.mask = kJoints, .joints_rad = {0, 0}};
  EXPECT_FALSE(alone.flies());
  EXPECT_EQ(level_of(alone.mask), std::nullopt);
  EXPECT_EQ(without_ignored(alone), alone);
  const std::vector<TimedSetpoint> two = {{Duration(0), {}}, {Duration(1), alone}};
  EXPECT_THAT(complaint_about(two, limits), HasSubstr("a command of their own"));
  EXPECT_EQ(heading_velocity({.mask = kVelocity | kJoints, .joints_rad = {0, 0}}), std::nullopt)
      << "the joints would be lost";
  EXPECT_NE(heading_velocity(flight_of({.mask = kVelocity | kJoints, .joints_rad = {0, 0}})),
            std::nullopt);
}

TEST(Setpoint, IgnoresFieldsOutsideTheMask) {
  Setpoint setpoint{.mask = kAttitude | kThrust, .p_WB_m = {kNan, 0, 0}, .thrust_N = 5};
  setpoint.rotor_speeds_rad_s = {-1};
  EXPECT_EQ(complaint_about(setpoint, kLimits), "");
  EXPECT_EQ(without_ignored(setpoint), (Setpoint{.mask = kAttitude | kThrust, .thrust_N = 5}));
}

TEST(Setpoint, AVelocityInTheHeadingFrameIsOneInAnyForm) {
  const VelocityCommand command{{1, 2, 3}, 0.5};
  EXPECT_EQ(heading_velocity(to_setpoint(command)), command);
  EXPECT_EQ(heading_velocity({.mask = kVelocity, .yaw_rate_rad_s = 9}), VelocityCommand{});
  EXPECT_EQ(heading_velocity({.in_heading = false}), std::nullopt);
  EXPECT_EQ(heading_velocity({.mask = kVelocity | kYaw}), std::nullopt);
  EXPECT_EQ(complaint_about(Setpoint{}, FlightLimits{}), "");
  EXPECT_THAT(complaint_about({.in_heading = false}, FlightLimits{}),
              testing::HasSubstr("only takes velocities"));
}

TEST(FlightLimits, AreThoseOfAllRotors) {
  const MultirotorParameters p = hummingbird();
  EXPECT_EQ(flight_limits(p), (FlightLimits{4, 838.0, 4 * max_rotor_thrust_N(p)}));
}

}  // namespace
}  // namespace tether::uav
