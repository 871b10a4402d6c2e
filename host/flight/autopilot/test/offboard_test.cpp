#include "flight.h"

namespace tether::autopilot {
namespace {

constexpr double kNorth = 1.5707963267948966;  // yaw in W

/// Flies in OFFBOARD from (0, 0, 5), heading east unless the case says otherwise.
struct InOffboard : Flight {
  explicit InOffboard(const Message& to, double seconds, double yaw_rad = 0.0)
      : Flight(Flight::in_air(), {0, 0, 5.0}, yaw_rad) {
    stream(to, 1.2, 50.0);
    EXPECT_EQ(mode(6), kAccepted);
    stream(to, seconds, 50.0);
    EXPECT_EQ(shown_mode(), "OFFBOARD");
  }
};
testing::AssertionResult is_near(const uav::Vec3& a, const uav::Vec3& b, double most) {
  if (norm(a - b) < most) return testing::AssertionSuccess();
  return testing::AssertionFailure()
         << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y << " " << b.z;
}

TEST(Offboard, NeedsAStreamOfASecond) {
  struct Case {
    double seconds, rate_hz;
    long result;
  };
  for (const auto& [seconds, rate_hz, result] : {Case{0.9, 20, kRejected},
                                                 {1.1, 20, kAccepted},
                                                 {1.9, 2.2, kAccepted},
                                                 {6.0, 1.5, kRejected}}) {
    Flight flight(Flight::in_air(), {0, 0, 5.0});
    flight.run(0.1);
    flight.stream(position_target(0, 0, 0), seconds, rate_hz);
    EXPECT_EQ(flight.mode(6), result) << seconds << " s at " << rate_hz << " Hz";
    EXPECT_EQ(flight.was_said("OFFBOARD denied"), result != kAccepted);
  }
  Flight flight(Flight::in_air(), {0, 0, 5.0});
  flight.run(0.1);
  flight.stream(position_target(0, 0, 0), 2.0);
  flight.run(0.6);
  EXPECT_EQ(flight.mode(6), kRejected) << "it has ended";
}

TEST(Offboard, LostSetPointsAreAFailsafe) {
  struct Case {
    double action;
    const char* mode;
  };
  for (const auto& [action, mode] :
       {Case{0, "AUTO.LOITER"}, {3, "AUTO.RTL"}, {4, "AUTO.LAND"}, {5, "AUTO.LOITER"}}) {
    Flight flight(Flight::in_air({{"COM_OBL_RC_ACT", action}, {"COM_OF_LOSS_T", 0.7}}),
                  {0, 0, 5.0});
    flight.run(0.1);
    flight.stream(position_target(0, 0, 0), 1.2);
    ASSERT_EQ(flight.mode(6), kAccepted);
    flight.stream(position_target(0, 0, 0), 1.0);
    const SimTime until = flight.now;
    ASSERT_TRUE(flight.run_until([&, wanted = mode] { return flight.shown_mode() == wanted; }, 5.0))
        << mode;
    EXPECT_NEAR(to_seconds(flight.now - until), 0.7, 0.06);
    EXPECT_TRUE(flight.was_said("no set-points"));
    EXPECT_EQ(flight.last("HEARTBEAT")->integer("system_status"), 5) << "critical";
    flight.stream(position_target(0, 0, 0), 1.2);
    ASSERT_EQ(flight.mode(6), kAccepted) << "the program may go on";
    EXPECT_EQ(flight.last("HEARTBEAT")->integer("system_status"), 4);
  }
}

TEST(Offboard, FollowsPositionsOfTheLocalFrame) {
  InOffboard flight(position_target(2.0, 3.0, -1.0).set("yaw", 5.0), 6.0);
  EXPECT_TRUE(is_near(flight.body.p_WB, {3.0, 2.0, 6.0}, 0.05)) << "from where it started";
  EXPECT_NEAR(flight.yaw(), 0.0, 0.02) << "a yaw that is masked has no effect";
  EXPECT_NEAR(flight.last("POSITION_TARGET_LOCAL_NED")->number("x"), 2.0, 1e-3);
}

TEST(Offboard, TurnsToAYawAndByARate) {
  InOffboard turned(target(kPositionOnly & ~1024).set("yaw", -0.5), 4.0);
  EXPECT_NEAR(turned.yaw(), kNorth + 0.5, 0.02);
  InOffboard turning(target(kPositionOnly & ~2048).set("yaw_rate", 0.5), 2.0);
  EXPECT_NEAR(turning.body.w_WB_B.z, -0.5, 0.05) << "clockwise";
}

TEST(Offboard, FollowsVelocities) {
  InOffboard flight(target(kVelocityOnly).set("vx", 1.0).set("vy", -0.5).set("vz", -0.3), 4.0);
  EXPECT_TRUE(is_near(flight.body.v_WB, {-0.5, 1.0, 0.3}, 0.05));
}

TEST(Offboard, FollowsVelocitiesOfTheBody) {
  InOffboard flight(target(kVelocityOnly, 8).set("vx", 1.0).set("vy", -0.5).set("vz", -0.3), 4.0,
                    1.0);
  const uav::Vec3 expected = rotate(uav::from_rpy(0, 0, flight.yaw()), {1.0, 0.5, 0.3});
  EXPECT_TRUE(is_near(flight.body.v_WB, expected, 0.05));
}

TEST(Offboard, FollowsPositionsWithVelocities) {
  InOffboard flight(target(kPositionOnly & ~56).set("x", 1.0).set("z", 0.0), 5.0);
  EXPECT_TRUE(is_near(flight.body.p_WB, {0.0, 1.0, 5.0}, 0.05));
}

TEST(Offboard, HoldsSomeAxesAndMovesOthers) {
  // x and y by velocity, z by position.
  const int mask = 0x0DFF & ~(4 | 8 | 16);
  InOffboard flight(target(mask).set("vx", 0.5).set("z", -1.0), 6.0);
  EXPECT_NEAR(flight.body.p_WB.z, 6.0, 0.05);
  EXPECT_NEAR(flight.body.v_WB.y, 0.5, 0.05);
  EXPECT_NEAR(flight.body.v_WB.x, 0.0, 0.05);
  InOffboard far(target(0x0DFF & ~(1 | 2)).set("x", 500.0), 3.0);
  EXPECT_GT(far.body.v_WB.y, 3.0);
}

TEST(Offboard, FollowsAccelerations) {
  InOffboard flight(target(0x0C3F).set("afx", 0.5), 1.0);
  EXPECT_GT(flight.body.v_WB.y, 0.3);
  EXPECT_NEAR(flight.body.v_WB.x, 0.0, 0.1);
}

TEST(Offboard, FollowsPositionsOfTheEarth) {
  for (const int frame : {0, 5, 3, 6}) {
    const bool is_relative = frame == 3 || frame == 6;
    const Message to = Message("SET_POSITION_TARGET_GLOBAL_INT")
                           .set("target_system", 1)
                           .set("coordinate_frame", frame)
                           .set("type_mask", kPositionOnly)
                           .set("lat_int", 271)  // 3 m
                           .set("lon_int", -180)
                           .set("alt", is_relative ? 1.0 : 6.0);
    InOffboard flight(to, 6.0);
    EXPECT_TRUE(is_near(flight.body.p_WB, {-2.0, 3.0, 6.0}, 0.1)) << frame;
  }
}

TEST(Offboard, FollowsAttitudeAndThrust) {
  const double most_N = uav::flight_limits(uav::hummingbird()).max_thrust_N;
  const double hover = uav::hummingbird().mass_kg * Flight::kGravity / most_N;
  // Nose down by 0.1 rad, heading north: it accelerates to the north.
  const uav::Quat q = uav::from_rpy(0.0, -0.1, 0.0);
  const Message to = Message("SET_ATTITUDE_TARGET")
                         .set("target_system", 1)
                         .set("type_mask", 7)
                         .set("q", 2 * q.w, 0)  // of any length
                         .set("q", 2 * q.x, 1)
                         .set("q", 2 * q.y, 2)
                         .set("q", 2 * q.z, 3)
                         .set("thrust", hover / std::cos(0.1));
  InOffboard flight(to, 1.5);
  EXPECT_NEAR(flight.yaw(), kNorth, 0.05);
  EXPECT_NEAR(flight.tilt(), 0.1, 0.02);
  EXPECT_GT(flight.body.v_WB.y, 0.7);
  EXPECT_NEAR(flight.body.v_WB.x, 0.0, 0.3);
  EXPECT_NEAR(flight.last("ATTITUDE")->number("pitch"), -0.1, 0.02);
}

TEST(Offboard, FollowsRatesAndThrust) {
  const double most_N = uav::flight_limits(uav::hummingbird()).max_thrust_N;
  const Message to = Message("SET_ATTITUDE_TARGET")
                         .set("target_system", 1)
                         .set("type_mask", 128)
                         .set("body_yaw_rate", 0.6)
                         .set("thrust", uav::hummingbird().mass_kg * Flight::kGravity / most_N);
  InOffboard flight(to, 1.0);
  EXPECT_NEAR(flight.body.w_WB_B.z, -0.6, 0.05);
  EXPECT_NEAR(flight.last("ATTITUDE")->number("yawspeed"), 0.6, 0.05);
}

TEST(Offboard, RefusesNonsenseAndSaysSoOnce) {
  const Message zero_q =
      Message("SET_ATTITUDE_TARGET").set("target_system", 1).set("thrust", 0.5).set("type_mask", 7);
  const std::pair<Message, const char*> cases[] = {
      {position_target(kNone, 0, 0), "must be finite"},
      {position_target(0, 0, 1e9), "position"},
      {target(kVelocityOnly).set("vx", 1e30), "velocity"},
      {target(0x0DFF), "neither"},
      {target(kPositionOnly, 8), "neither"},
      {target(kPositionOnly, 9), "frame 9"},
      {target(kPositionOnly | 512), "forces"},
      {target(kPositionOnly & ~1024).set("yaw", kNone), "yaw"},
      {zero_q, "attitude"},
      {Message(zero_q).set("q", 1.0, 0).set("thrust", kNone), "thrust"},
      {Message(zero_q).set("q", 1.0, 0).set("thrust", 5.0), "thrust"},
      {Message(zero_q).set("q", 1.0, 0).set("type_mask", 7 | 64), "no thrust"},
      {Message(zero_q).set("type_mask", 128 | 4), "rates"},
  };
  for (const auto& [message, text] : cases) {
    Flight flight(Flight::in_air(), {0, 0, 5.0});
    flight.run(0.1);
    flight.stream(message, 1.5);
    EXPECT_EQ(flight.mode(6), kRejected) << text << ": it is no stream";
    flight.heard.clear();
    flight.stream(message, 0.2);
    EXPECT_FALSE(flight.was_said("set-point ignored")) << text << ": it was said before";
    const std::size_t refused = flight.refused;
    EXPECT_GT(refused, 0U);
    flight.stream(position_target(0, 0, 0), 0.1);
    EXPECT_EQ(flight.refused, refused);
    flight.stream(position_target(0, 0, 0).set("target_system", 42), 0.1);
    EXPECT_GT(flight.refused, refused);
    flight.stream(message, 0.1);
    EXPECT_TRUE(flight.was_said("set-point ignored")) << text;
    EXPECT_TRUE(flight.was_said(text)) << flight.last("STATUSTEXT")->text("text");
    EXPECT_LT(norm(flight.body.p_WB - uav::Vec3{0, 0, 5.0}), 0.1);
  }
}

}  // namespace
}  // namespace tether::autopilot
