#include "flight.h"

#include <tether/base/random.h>

namespace tether::autopilot {
namespace {

TEST(BuiltIn, IsSetDownBeforeItBoots) {
  Flight flight({}, {0, 0, 0.3});
  flight.run(0.9);
  EXPECT_TRUE(flight.heard.empty());
  ASSERT_TRUE(flight.run_until([&] { return !flight.heard.empty(); }, 5.0));
  EXPECT_EQ(flight.body.p_WB.z, 0.0);
  EXPECT_FALSE(flight.is_armed());
  EXPECT_EQ(flight.last("EXTENDED_SYS_STATE")->integer("landed_state"), 1);
}

TEST(BuiltIn, BootsOnAPlatformThatMoves) {
  Flight flight;
  flight.carried_m_s = {1.0, 0.0, 0.0};
  flight.boot();
  EXPECT_FALSE(flight.heard.empty());
}

TEST(BuiltIn, MayStartInTheAir) {
  Flight flight(Flight::in_air(), {1, 2, 3});
  flight.run(2.0);
  EXPECT_TRUE(flight.is_armed());
  EXPECT_EQ(flight.shown_mode(), "AUTO.LOITER");
  EXPECT_LT(norm(flight.body.p_WB - uav::Vec3{1, 2, 3}), 0.05);
}

TEST(BuiltIn, AnswersPingAndTimesync) {
  Flight flight;
  flight.boot();
  flight.heard.clear();
  flight.send(Message("TIMESYNC").set("ts1", 12'345));
  flight.send(Message("TIMESYNC").set("tc1", 1).set("ts1", 2));
  flight.send(Message("PING").set("seq", 7), {42, 8});
  flight.run(0.004);
  EXPECT_EQ(flight.count("TIMESYNC"), 1U) << "an answer is not answered";
  EXPECT_EQ(flight.last("TIMESYNC")->integer("ts1"), 12'345);
  EXPECT_EQ(flight.last("TIMESYNC")->integer("tc1"), to_ns(flight.now) - 4'000'000);
  ASSERT_NE(flight.last("PING"), nullptr);
  EXPECT_EQ(flight.last("PING")->integer("target_system"), 42);
  EXPECT_EQ(flight.last("PING")->integer("seq"), 7);
}

TEST(BuiltIn, ReadsFramesAmongGarbage) {
  Flight flight;
  flight.boot();
  flight.heard.clear();
  const Bytes frame = encode(Message("TIMESYNC").set("ts1", 5), {1, 191}, 0);
  flight.send_bytes({1, 2, 0xFD, 3});
  flight.send_bytes({});
  flight.send_bytes(Bytes(frame.begin(), frame.begin() + 9));
  Bytes amid(300, 0x55);
  amid.insert(amid.begin() + 100, frame.begin(), frame.end());
  flight.send_bytes(amid);
  flight.run(0.004);
  EXPECT_EQ(flight.count("TIMESYNC"), 1U);
}

/// Of 256 systems: to others, half of one, with a wrong checksum, of version 1, or no frame at all.
Bytes of_others(KeyedRandom& random) {
  const auto types = mavlink::message_types();
  Message message(types[random.bits() % types.size()]);
  for (const mavlink::Field& field : message.type().fields)
    message.set(field.name, static_cast<std::int64_t>(random.bits()), random.bits() % field.count);
  if (message.type().field("target_system") != nullptr)
    message.set("target_system", 2 + random.bits() % 250);
  Bytes bytes = mavlink::encode(
      message, {static_cast<std::uint8_t>(random.bits()), static_cast<std::uint8_t>(random.bits())},
      0);
  const std::uint32_t kind = random.bits() % 5;
  if (kind == 0) bytes.resize(bytes.size() / 2);
  if (kind == 1) bytes[10 + random.bits() % (bytes.size() - 10)] ^= 1;
  if (kind == 2) bytes[0] = 0xFE;
  if (kind == 3)
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.bits());
  return bytes;
}

TEST(BuiltIn, AnHonestCompanionIsUnharmedByWhatOthersSend) {
  KeyedRandom random({.seed = 41});
  Flight flight;
  flight.take_off();
  const Message to = position_target(2.0, 0.0, -2.5);
  flight.stream(to, 1.2);
  ASSERT_EQ(flight.mode(6), kAccepted);
  std::uint32_t asked = 0;
  flight.heard.clear();
  flight.run(6.0, [&] {
    for (std::uint32_t i = random.bits() % 20; i > 0; --i) flight.send_bytes(of_others(random));
    flight.send(to);
    flight.send(Message("PING").set("seq", ++asked), {42, 8});
  });
  std::uint32_t answered = 0;
  for (const Message& m : flight.heard) {
    if (m.is("PING") && m.integer("target_system") == 42) {
      EXPECT_EQ(m.integer("seq"), ++answered);
    }
  }
  EXPECT_EQ(answered, asked);
  EXPECT_EQ(flight.shown_mode(), "OFFBOARD");
  EXPECT_LT(norm(flight.body.p_WB - uav::Vec3{0, 2.0, 2.5}), 0.1);
}

// The estimate goes where it was sent; the vehicle is beside by the drift.
TEST(BuiltIn, FliesOnItsOdometry) {
  Flight flight;
  flight.has_odometry = true;
  flight.drift_m = {0.4, -0.2, 0.1};
  flight.take_off();
  const Message to = position_target(2.0, 0.0, -2.5);  // 2 m to the north of the start
  flight.stream(to, 1.2);
  flight.drift_m_s = {0.05, 0.0, 0.0};
  ASSERT_EQ(flight.mode(6), kAccepted);
  flight.stream(to, 8.0);
  const uav::Vec3 start_W{0.4, -0.2, 0.1};  // of the estimate
  const uav::Vec3 estimate = flight.body.p_WB + flight.drift_m;
  EXPECT_LT(norm(estimate - start_W - uav::Vec3{0, 2.0, 2.5}), 0.1);
  EXPECT_LT(flight.body.p_WB.x, -0.3) << "so the vehicle moves against the drift";
  EXPECT_NEAR(flight.last("LOCAL_POSITION_NED")->number("x"), 2.0, 0.1);
}

TEST(BuiltIn, TurnsTheEstimateToTheYawThatIsAskedFor) {
  Flight flight;
  flight.has_odometry = true;
  flight.drift_rad = 0.3;
  flight.take_off();
  Message to = target(kPositionOnly & ~1024).set("z", -2.5).set("yaw", 1.0);
  flight.stream(to, 1.2);
  ASSERT_EQ(flight.mode(6), kAccepted);
  flight.stream(to, 4.0);
  EXPECT_NEAR(flight.last("ATTITUDE")->number("yaw"), 1.0, 0.02);
  EXPECT_NEAR(flight.yaw(), 1.5708 - 1.0 - 0.3, 0.02);
}

TEST(BuiltIn, AVelocityIsThatOfTheEstimate) {
  Flight flight;
  flight.has_odometry = true;
  flight.take_off();
  const Message to = target(kVelocityOnly).set("vx", 1.0);
  flight.stream(to, 1.2);
  flight.drift_m_s = {0.0, 0.3, 0.0};
  ASSERT_EQ(flight.mode(6), kAccepted);
  flight.stream(to, 4.0);
  EXPECT_NEAR(flight.body.v_WB.y, 0.7, 0.05);
}

TEST(BuiltIn, StaysOnTheGroundWhileItsEstimateDrifts) {
  Flight flight({.parameters = {{"COM_DISARM_PRFLT", -1.0}}});
  flight.has_odometry = true;
  flight.boot();
  flight.command(kArmCommand, {1});
  for (const double drift : {0.05, -0.05}) {
    flight.drift_m_s.z = drift;
    flight.run(10.0);
    EXPECT_EQ(flight.body.p_WB.z, 0.0);
    EXPECT_EQ(flight.last("EXTENDED_SYS_STATE")->integer("landed_state"), 1);
  }
}

TEST(BuiltIn, IsAFunctionOfWhatItIsGiven) {
  const auto fly = [] {
    Flight flight;
    flight.take_off();
    flight.stream(position_target(1, 1, -2), 1.2);
    flight.mode(6);
    flight.stream(position_target(1, 1, -2), 2.0);
    return flight.body.p_WB;
  };
  EXPECT_EQ(fly(), fly());
}

}  // namespace
}  // namespace tether::autopilot
