#include "flight.h"

namespace tether::autopilot {
namespace {

double horizontal(const uav::Vec3& v) {
  return std::hypot(v.x, v.y);
}

TEST(Navigator, TakesOffToTheParametersHeightAndHolds) {
  Flight flight({.parameters = {{"MIS_TAKEOFF_ALT", 4.0}}});
  flight.boot();
  flight.command(kArmCommand, {1});
  flight.command(kTakeOffCommand);
  double fastest = 0.0;
  flight.run(1.0);
  EXPECT_EQ(flight.shown_mode(), "AUTO.TAKEOFF");
  EXPECT_EQ(flight.last("EXTENDED_SYS_STATE")->integer("landed_state"), 3);
  flight.run(6.0, [&] { fastest = std::max(fastest, flight.body.v_WB.z); });
  EXPECT_EQ(flight.shown_mode(), "AUTO.LOITER");
  EXPECT_EQ(flight.last("EXTENDED_SYS_STATE")->integer("landed_state"), 2);
  EXPECT_TRUE(flight.was_said("took off"));
  EXPECT_NEAR(flight.body.p_WB.z, 4.0, 0.32);
  EXPECT_NEAR(fastest, 1.5, 0.15) << "MPC_TKO_SPEED";
  flight.run(5.0);
  EXPECT_NEAR(flight.body.p_WB.z, 4.0, 0.03);
  EXPECT_LT(horizontal(flight.body.p_WB), 0.05);
}

TEST(Navigator, TakesOffToTheAltitudeOfTheCommand) {
  for (const bool arms_later : {false, true}) {
    Flight flight;
    flight.boot();
    if (!arms_later) flight.command(kArmCommand, {1});
    EXPECT_EQ(flight.command(kTakeOffCommand, {0, 0, 0, kNone, kNone, kNone, 6.0}), kAccepted);
    if (arms_later) flight.command(kArmCommand, {1});
    flight.run(10.0);
    EXPECT_NEAR(flight.body.p_WB.z, 6.0, 0.32);
  }
  Flight flight;
  flight.boot();
  flight.command(kArmCommand, {1});
  flight.command(kTakeOffCommand, {0, 0, 0, kNone, kNone, kNone, -3.0});
  flight.run(8.0);
  EXPECT_NEAR(flight.body.p_WB.z, 2.5, 0.32) << "below the vehicle: MIS_TAKEOFF_ALT";
}

TEST(Navigator, ATakeOffInTheAirDoesNotDescend) {
  Flight flight({.parameters = {{"MIS_TAKEOFF_ALT", 8.0}}});
  flight.take_off();
  flight.run(3.0);
  EXPECT_EQ(flight.command(kTakeOffCommand, {0, 0, 0, kNone, kNone, kNone, 2.0}), kAccepted);
  flight.run(3.0);
  EXPECT_NEAR(flight.body.p_WB.z, 8.0, 0.3);
}

TEST(Navigator, ACommandIsStrongerThanTheEndOfAMode) {
  Flight flight;
  flight.boot();
  flight.command(kArmCommand, {1});
  flight.command(kTakeOffCommand);
  // At each step it could come to its end.
  flight.run_until(
      [&] {
        if (flight.body.p_WB.z > 1.8)
          flight.send(Message("SET_MODE")
                          .set("target_system", 1)
                          .set("base_mode", 1)
                          .set("custom_mode", 6U << 24 | 4U << 16));
        return flight.body.p_WB.z > 2.3;
      },
      4.0);
  flight.run(1.0);
  EXPECT_EQ(flight.shown_mode(), "AUTO.LAND");
}

TEST(Navigator, LandsAndDisarms) {
  Flight flight({.parameters = {{"COM_DISARM_LAND", 1.0}}});
  flight.take_off();
  EXPECT_EQ(flight.command(kLandCommand), kAccepted);
  EXPECT_EQ(flight.shown_mode(), "AUTO.LAND");
  flight.run(1.5);
  EXPECT_EQ(flight.last("EXTENDED_SYS_STATE")->integer("landed_state"), 4);
  EXPECT_NEAR(flight.body.v_WB.z, -0.7, 0.05) << "MPC_LAND_SPEED";
  ASSERT_TRUE(flight.run_until([&] { return flight.was_said("landed"); }, 10.0));
  EXPECT_EQ(flight.body.p_WB.z, 0.0);
  EXPECT_TRUE(flight.is_armed());
  const SimTime landed_at = flight.now;
  ASSERT_TRUE(flight.run_until([&] { return !flight.is_armed(); }, 10.0));
  EXPECT_NEAR(to_seconds(flight.now - landed_at), 1.0, 0.05);
  EXPECT_EQ(flight.shown_mode(), "AUTO.LOITER");
  EXPECT_EQ(flight.command(kArmCommand, {1}), kAccepted) << "it can fly again";
}

TEST(Navigator, LandsAlsoIfItIsAskedAgainAndAgain) {
  Flight flight;
  flight.take_off();
  for (int i = 0; i < 60 && flight.is_armed(); ++i) {
    flight.command(kLandCommand);
    flight.run(0.2);
  }
  EXPECT_FALSE(flight.is_armed());
}

TEST(Navigator, LandsFastFromHighUp) {
  Flight flight({.parameters = {{"MIS_TAKEOFF_ALT", 12.0}}});
  flight.take_off();
  flight.command(kLandCommand);
  flight.run(2.0);
  EXPECT_NEAR(flight.body.v_WB.z, -1.5, 0.1) << "MPC_Z_V_AUTO_DN";
}

TEST(Navigator, LandsOnAPlatformThatMoves) {
  Flight flight;
  flight.take_off();
  flight.carried_m_s = {0.8, 0.0, 0.0};
  flight.command(kLandCommand);
  EXPECT_TRUE(flight.run_until([&] { return flight.was_said("landed"); }, 10.0));
}

TEST(Navigator, StopsWhereItCanBrake) {
  Flight flight(Flight::in_air(), {0, 0, 5.0});
  flight.run(0.1);
  const Message to = target(kVelocityOnly).set("vx", 4.0);
  flight.stream(to, 1.2);
  flight.mode(6);
  flight.stream(to, 4.0);
  const uav::Vec3 before = flight.body.p_WB;
  flight.mode(4, 3);
  uav::Vec3 furthest = before;
  flight.run(8.0, [&] {
    if (flight.body.p_WB.y > furthest.y) furthest = flight.body.p_WB;
  });
  EXPECT_NEAR(flight.body.p_WB.y - before.y, 4.0 * 4.0 / 3.0, 1.0) << "v²/2a at half of it";
  EXPECT_LT(furthest.y - flight.body.p_WB.y, 0.5) << "without coming back";
}

TEST(Navigator, ReturnsHomeAndLands) {
  Flight flight(
      {.parameters = {{"RTL_RETURN_ALT", 8.0}, {"RTL_MIN_DIST", 2.0}, {"RTL_DESCEND_ALT", 4.0}}},
      {1.0, 2.0, 0.0}, 0.5);
  flight.take_off();
  const Message away = position_target(12.0, 0.0, -3.0);
  flight.stream(away, 1.2);
  flight.mode(6);
  flight.stream(away, 8.0);
  ASSERT_NEAR(flight.body.p_WB.y, 14.0, 0.2);
  EXPECT_EQ(flight.command(kReturnCommand), kAccepted);
  EXPECT_EQ(flight.shown_mode(), "AUTO.RTL");
  double highest = 0.0, lowest_away = 100.0, fastest = 0.0;
  flight.run_until([&] {
    highest = std::max(highest, flight.body.p_WB.z);
    fastest = std::max(fastest, horizontal(flight.body.v_WB));
    const double away_m = horizontal(flight.body.p_WB - uav::Vec3{1.0, 2.0, 0.0});
    if (away_m > 2.0 && away_m < 11.0) lowest_away = std::min(lowest_away, flight.body.p_WB.z);
    return !flight.is_armed();
  });
  EXPECT_FALSE(flight.is_armed());
  EXPECT_NEAR(highest, 8.0, 0.4);
  EXPECT_GT(lowest_away, 7.5) << "it flies at the height of return";
  EXPECT_GT(fastest, 3.0);
  EXPECT_LT(horizontal(flight.body.p_WB - uav::Vec3{1.0, 2.0, 0.0}), 0.3);
  EXPECT_NEAR(flight.yaw(), 0.5, 0.05) << "with the heading of its start";
}

TEST(Navigator, ReturnsWithoutAClimbIfItIsNear) {
  Flight flight;
  flight.take_off();
  flight.command(kReturnCommand);
  double highest = 0.0;
  flight.run_until([&] {
    highest = std::max(highest, flight.body.p_WB.z);
    return !flight.is_armed();
  });
  EXPECT_LT(highest, 3.0);
  EXPECT_EQ(flight.body.p_WB.z, 0.0);
}

TEST(Navigator, KnowsWhereNorthIs) {
  // North is 0.5 rad to the left of W's y.
  BuiltInSettings settings{.starts_in_air = true};
  Flight flight(settings, {0, 0, 5.0}, 0.0, 0.5);
  flight.run(0.1);
  const Message to = position_target(4.0, 0.0, 0.0);
  flight.stream(to, 1.2);
  flight.mode(6);
  flight.stream(to, 6.0);
  EXPECT_LT(norm(flight.body.p_WB - uav::Vec3{-4.0 * std::sin(0.5), 4.0 * std::cos(0.5), 5.0}),
            0.1);
  EXPECT_NEAR(flight.last("ATTITUDE")->number("yaw"), 1.5708 + 0.5, 0.02);
  EXPECT_NEAR(flight.last("GLOBAL_POSITION_INT")->number("lat"), 4.0 / 110'574.3 * 1e7, 5);
}

TEST(Navigator, DoesNotRiseFromTheGroundInHold) {
  Flight flight;
  flight.boot();
  flight.command(kArmCommand, {1});
  flight.run(5.0);
  EXPECT_EQ(flight.body.p_WB.z, 0.0);
  EXPECT_EQ(flight.setpoint.mask, uav::kRotorSpeeds);
  EXPECT_GT(flight.setpoint.rotor_speeds_rad_s.at(0), 0.0) << "the rotors idle";
}

TEST(Navigator, TakesOffAndLandsInOffboard) {
  for (const double climb_m_s : {0.1, 1.0}) {
    Flight flight;
    flight.boot();
    const Message up = target(kVelocityOnly).set("vz", -climb_m_s);
    flight.stream(up, 1.2);
    ASSERT_EQ(flight.mode(6), kAccepted);
    ASSERT_EQ(flight.command(kArmCommand, {1}), kAccepted);
    flight.stream(up, 1.5 / climb_m_s);
    EXPECT_NEAR(flight.body.p_WB.z, 1.5, 0.4);
    const double height = flight.body.p_WB.z;
    flight.stream(target(kVelocityOnly), 2.0);
    EXPECT_NEAR(flight.body.p_WB.z, height, 0.3) << "it stays in the air";
    flight.stream(target(kVelocityOnly).set("vz", 0.5), 7.0);
    EXPECT_TRUE(flight.was_said("landed"));
    EXPECT_FALSE(flight.is_armed()) << "and is disarmed then";
  }
}

}  // namespace
}  // namespace tether::autopilot
