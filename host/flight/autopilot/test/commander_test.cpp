#include "flight.h"

#include <tether/base/units.h>

namespace tether::autopilot {
namespace {

TEST(Commander, ArmsOnTheGroundAndSaysSo) {
  Flight flight;
  flight.boot();
  EXPECT_FALSE(flight.is_armed());
  EXPECT_EQ(flight.command(kArmCommand, {1}), kAccepted);
  EXPECT_TRUE(flight.was_said("armed"));
  EXPECT_TRUE(flight.is_armed()) << "a heartbeat shows it at once";
  EXPECT_EQ(flight.command(kArmCommand, {1}), kAccepted) << "it is armed already";
  EXPECT_EQ(flight.command(kArmCommand, {0}), kAccepted);
  EXPECT_FALSE(flight.is_armed());
  EXPECT_EQ(flight.command(kArmCommand, {0.4}), kUnsupported);
  EXPECT_EQ(flight.command(kArmCommand, {kNone}), kUnsupported);
}

// Down is negative for MAVLink, and positive about the body's left.
TEST(Commander, PointsAGimbal) {
  constexpr int kMountControl = 205, kPitchYaw = 1000;
  uav::FlightLimits limits;
  limits.joints = {{"yaw", {}, {0, 0, 1}, -2, 2, 1}, {"pitch", {}, {0, 1, 0}, 0.1, 1, 1}};
  Flight flight({.limits = limits});
  flight.boot();
  EXPECT_FALSE(flight.setpoint.has(uav::kJoints));
  EXPECT_EQ(flight.command(kMountControl, {-30, 0, kNone, 0, 0, 0, 2}), kAccepted);
  ASSERT_EQ(flight.setpoint.joints_rad.size(), 2u);
  EXPECT_EQ(flight.setpoint.joints_rad[0], 0.0);
  EXPECT_NEAR(flight.setpoint.joints_rad[1], rad_from_deg(30), 1e-12);
  flight.run(0.1);
  EXPECT_TRUE(flight.setpoint.has(uav::kJoints)) << "as long as it flies";
  EXPECT_EQ(flight.command(kPitchYaw, {kNone, 60, kNone, kNone, 0}), kAccepted);
  EXPECT_NEAR(flight.setpoint.joints_rad[0], rad_from_deg(-60), 1e-12);
  EXPECT_NEAR(flight.setpoint.joints_rad[1], rad_from_deg(30), 1e-12);
  EXPECT_EQ(flight.command(kPitchYaw, {0, 0, 5, 5, 0}), kUnsupported) << "rates";
  EXPECT_EQ(flight.command(kPitchYaw, {0, 0, kNone, kNone, 16}), kUnsupported) << "against north";
  Message by_int("COMMAND_INT");
  by_int.set("target_system", 1).set("command", kPitchYaw).set("x", 16);
  EXPECT_EQ(flight.acknowledged(by_int.set("param3", kNone).set("param4", kNone)), kUnsupported);
  EXPECT_EQ(flight.command(kMountControl, {0, 0, 0, 0, 0, 0, 3}), kUnsupported) << "by sticks";
  EXPECT_EQ(flight.command(kMountControl, {kNone, 0, kNone, 0, 0, 0, 2}), kDenied) << "roll";
  Flight without;
  without.boot();
  EXPECT_EQ(without.command(kMountControl, {-30, 0, 0, 0, 0, 0, 2}), kUnsupported);
}

TEST(Commander, DeniesArmingWithTheReason) {
  struct Case {
    double charge;
    int main, sub;
    const char* reason;
  };
  for (const auto& [charge, main, sub, reason] : {Case{0.1, 4, 3, "battery is low"},
                                                  {0.9, 4, 6, "not in AUTO.LAND"},
                                                  {0.9, 4, 5, "not in AUTO.RTL"},
                                                  {0.9, 6, 0, "OFFBOARD needs set-points"},
                                                  {0.9, 4, 4, "there is no mission"}}) {
    Flight flight;
    flight.charge = charge;
    flight.boot();
    EXPECT_EQ(flight.mode(main, sub), kAccepted) << "any mode can be chosen on the ground";
    EXPECT_EQ(flight.command(kArmCommand, {1}), kRejected) << reason;
    EXPECT_TRUE(flight.was_said("Arming denied")) << reason;
    EXPECT_TRUE(flight.was_said(reason)) << reason;
    EXPECT_EQ(flight.command(kArmCommand, {1, 21196}), kAccepted) << "without checks";
  }
}

TEST(Commander, DisarmsInTheAirOnlyByForceAndCanArmAgain) {
  Flight flight;
  flight.take_off();
  EXPECT_EQ(flight.command(kArmCommand, {0}), kRejected);
  EXPECT_TRUE(flight.was_said("Disarming denied"));
  EXPECT_TRUE(flight.is_armed());
  EXPECT_EQ(flight.command(kArmCommand, {0, 21196}), kAccepted);
  EXPECT_EQ(flight.setpoint.mask, uav::kRotorSpeeds);
  EXPECT_EQ(flight.setpoint.rotor_speeds_rad_s, std::vector<double>(4, 0.0));
  flight.run(3.0);
  EXPECT_EQ(flight.body.p_WB.z, 0.0) << "it fell";
  EXPECT_EQ(flight.command(kArmCommand, {1}), kAccepted);
}

TEST(Commander, DisarmsIfItDoesNotTakeOff) {
  Flight flight({.parameters = {{"COM_DISARM_PRFLT", 3.0}}});
  flight.boot();
  flight.command(kArmCommand, {1});
  flight.run(2.9);
  EXPECT_TRUE(flight.is_armed());
  flight.run(0.2);
  EXPECT_FALSE(flight.is_armed());
  Flight patient({.parameters = {{"COM_DISARM_PRFLT", -1.0}}});
  patient.boot();
  patient.command(kArmCommand, {1});
  patient.run(20.0);
  EXPECT_TRUE(patient.is_armed());
}

TEST(Commander, TakesModesByBothMessages) {
  Flight flight;
  flight.take_off();
  EXPECT_EQ(flight.mode(3), kAccepted);
  EXPECT_EQ(flight.shown_mode(), "POSCTL");
  flight.send(Message("SET_MODE")
                  .set("target_system", 1)
                  .set("base_mode", 1)
                  .set("custom_mode", 3U << 24 | 4U << 16));
  flight.run(0.01);
  EXPECT_EQ(flight.shown_mode(), "AUTO.LOITER");
  for (const auto& [main, sub] : {std::pair{1, 0}, {4, 0}, {4, 9}, {7, 0}, {-1, 0}, {300, 3}}) {
    EXPECT_EQ(flight.mode(main, sub), kRejected) << main << "." << sub;
    EXPECT_TRUE(flight.was_said("is not available"));
  }
  EXPECT_EQ(flight.command(kSetMode, {0, 4, 3}), kRejected) << "a mode of its own is needed";
  EXPECT_EQ(flight.command(kSetMode, {kNone, 4, 3}), kRejected);
  EXPECT_EQ(flight.mode(4, 4), kRejected);
  EXPECT_TRUE(flight.was_said("AUTO.MISSION denied: there is no mission"));
  EXPECT_EQ(flight.mode(6), kRejected);
  EXPECT_TRUE(flight.was_said("OFFBOARD denied"));
  EXPECT_EQ(flight.shown_mode(), "AUTO.LOITER");
}

TEST(Commander, IgnoresWhatIsForOthers) {
  Flight flight;
  flight.boot();
  EXPECT_EQ(flight.command(kArmCommand, {1}, 2), -1);
  EXPECT_FALSE(flight.is_armed());
  EXPECT_EQ(flight.command(kArmCommand, {1}, 0), kAccepted) << "for all";
  const auto to_component = [&](int component) {
    return flight.acknowledged(Message("COMMAND_LONG")
                                   .set("target_system", 1)
                                   .set("target_component", component)
                                   .set("command", 520));
  };
  EXPECT_EQ(to_component(100), -1);
  EXPECT_EQ(to_component(0), kAccepted);
}

TEST(Commander, AcknowledgesToTheSender) {
  Flight flight;
  flight.boot();
  flight.heard.clear();
  flight.send(Message("COMMAND_LONG").set("target_system", 1).set("command", 9999), {42, 7});
  flight.run(0.01);
  ASSERT_NE(flight.last("COMMAND_ACK"), nullptr);
  EXPECT_EQ(flight.last("COMMAND_ACK")->integer("command"), 9999);
  EXPECT_EQ(flight.last("COMMAND_ACK")->integer("result"), kUnsupported);
  EXPECT_EQ(flight.last("COMMAND_ACK")->integer("target_system"), 42);
  EXPECT_EQ(flight.last("COMMAND_ACK")->integer("target_component"), 7);
}

TEST(Commander, TakesHomeWhereItArmsAndByCommand) {
  Flight flight({}, {3.0, 4.0, 0.0});
  flight.boot();
  flight.command(kArmCommand, {1});
  flight.run(0.01);
  ASSERT_NE(flight.last("HOME_POSITION"), nullptr);
  EXPECT_NEAR(flight.last("HOME_POSITION")->number("x"), 0.0, 1e-3) << "of the local frame";
  constexpr int kSetHome = 179;
  EXPECT_EQ(flight.command(kSetHome, {0, 0, 0, 0, 95.0, 0.0, 0.0}), kDenied);
  EXPECT_EQ(flight.command(kSetHome, {0, 0, 0, 0, 1.0, 0.0, kNone}), kDenied);
  EXPECT_EQ(flight.command(kSetHome, {0, 0, 0, 0, 0.001, 0.0, 5.0}), kAccepted);
  flight.run(0.01);
  EXPECT_NEAR(flight.last("HOME_POSITION")->number("latitude"), 1e4, 1);
  EXPECT_NEAR(flight.last("HOME_POSITION")->number("altitude"), 5e3, 1);
  EXPECT_EQ(flight.command(kSetHome, {1}), kAccepted);
  EXPECT_EQ(flight.command(410), kAccepted);
  flight.run(0.01);
  EXPECT_NEAR(flight.last("HOME_POSITION")->number("altitude"), 0.0, 50);
}

TEST(Commander, RepositionsInHold) {
  constexpr int kReposition = 192;
  Flight flight;
  flight.boot();
  EXPECT_EQ(flight.command(kReposition, {-1, 1, 0, kNone, 1e-5, 0, kNone}), kRejected);
  flight.take_off();
  EXPECT_EQ(flight.command(kReposition, {-1, 0, 0, kNone, 1e-5, 0, 4.0}), kUnsupported);
  const Message to = Message("COMMAND_INT")
                         .set("target_system", 1)
                         .set("target_component", 1)
                         .set("command", kReposition)
                         .set("frame", 6)
                         .set("param1", -1)
                         .set("param2", 1)
                         .set("param4", kNone)
                         .set("x", 900)  // 10 m to the north
                         .set("y", 0)
                         .set("z", 4.0);
  EXPECT_EQ(flight.acknowledged(to), kAccepted);
  flight.run(12.0);
  EXPECT_NEAR(flight.body.p_WB.y, 9.95, 0.1);
  EXPECT_NEAR(flight.body.p_WB.z, 4.0, 0.1);
  Message yaw = to;
  yaw.set("x", std::int64_t{2147483647}).set("y", std::int64_t{2147483647}).set("z", kNone);
  EXPECT_EQ(flight.acknowledged(yaw.set("param4", 1.0)), kAccepted);
  flight.run(5.0);
  EXPECT_NEAR(flight.body.p_WB.y, 9.95, 0.1) << "the place is kept";
  EXPECT_NEAR(flight.yaw(), 1.5708 - 1.0, 0.02) << "clockwise from north";
  for (const int command : {kReposition, kTakeOffCommand}) {
    EXPECT_EQ(flight.command(command, {-1, 1, 0, kNone, 999.0, 0, kNone}), kDenied);
    EXPECT_EQ(flight.command(command, {-1, 1, 0, kNone, 0, -181.0, kNone}), kDenied);
    EXPECT_EQ(flight.command(command, {-1, 1, 0, kNone, 0, 0, -1e30}), kDenied);
    EXPECT_EQ(flight.command(command, {-1, 1, 0, kNone, 0, 0, kInfinite}), kDenied);
  }
}

TEST(Commander, LandsOrReturnsWithAnEmptyBattery) {
  struct Case {
    double action, charge;
    const char* mode;
  };
  for (const auto& [action, charge, mode] : {Case{0, 0.04, "AUTO.LOITER"},
                                             {2, 0.1, "AUTO.LOITER"},
                                             {2, 0.06, "AUTO.LAND"},
                                             {3, 0.06, "AUTO.RTL"},
                                             {3, 0.04, "AUTO.LAND"}}) {
    Flight flight({.parameters = {{"COM_LOW_BAT_ACT", action}}});
    flight.charge = 0.9;
    flight.take_off();
    flight.heard.clear();
    flight.charge = charge;
    flight.run(1.0);
    EXPECT_EQ(flight.shown_mode(), mode) << action << " at " << charge;
    EXPECT_TRUE(flight.was_said("battery"));
    EXPECT_NEAR(flight.last("SYS_STATUS")->number("battery_remaining"), 100 * charge, 0.5);
  }
  Flight flight({.parameters = {{"COM_LOW_BAT_ACT", 3}}});
  flight.charge = 0.9;
  flight.take_off();
  flight.charge = 0.06;
  flight.run(1.0);
  flight.charge = 0.04;
  flight.run(1.0);
  EXPECT_EQ(flight.shown_mode(), "AUTO.LAND") << "a return does not go on until it falls";
}

TEST(Commander, SurvivesAnyCommand) {
  Flight flight;
  flight.take_off();
  for (const double value :
       {kNone, 1e38, -1e38, -1.0, 4e9, std::numeric_limits<double>::infinity()})
    for (const int id :
         {16, 17, 20, 21, 22, 176, 178, 179, 192, 300, 400, 410, 510, 511, 512, 520}) {
      flight.command(id, {value, value, value, value, value, value, value});
      flight.command(id, {1, 1, value, value, value, value, value});
      flight.run(0.05);
    }
  EXPECT_TRUE(std::isfinite(norm(flight.body.p_WB)));
}

}  // namespace
}  // namespace tether::autopilot
