#include "flight.h"

#include <numbers>

#include <tether/mavlink/message.h>

namespace tether::autopilot {
namespace {

constexpr int kGetInterval = 510, kSetInterval = 511, kRequest = 512;

double id_of(const char* name) {
  return mavlink::find_type(name)->id;
}

TEST(Telemetry, SendsEachMessageAtItsRate) {
  Flight flight;
  flight.boot();
  flight.heard.clear();
  flight.run(20.0);
  for (const auto& [name, rate_hz] : {std::pair{"HEARTBEAT", 1.0},
                                      {"ATTITUDE", 100.0},
                                      {"LOCAL_POSITION_NED", 30.0},
                                      {"GLOBAL_POSITION_INT", 50.0},
                                      {"BATTERY_STATUS", 0.5},
                                      {"EXTENDED_SYS_STATE", 5.0}})
    EXPECT_NEAR(static_cast<double>(flight.count(name)), 20.0 * rate_hz, 1.0) << name;
  EXPECT_EQ(flight.count("AUTOPILOT_VERSION"), 0U);
}

TEST(Telemetry, ChangesIntervals) {
  Flight flight;
  flight.boot();
  const auto rate_hz = [&](const char* name) {
    flight.run(0.5);
    flight.heard.clear();
    flight.run(4.0);
    return static_cast<double>(flight.count(name)) / 4.0;
  };
  const double attitude = id_of("ATTITUDE"), home = id_of("HOME_POSITION");
  EXPECT_EQ(flight.command(kSetInterval, {attitude, 1e5}), kAccepted);
  EXPECT_NEAR(rate_hz("ATTITUDE"), 10.0, 0.5);
  EXPECT_EQ(flight.command(kSetInterval, {attitude, -1}), kAccepted);
  EXPECT_EQ(rate_hz("ATTITUDE"), 0.0);
  EXPECT_EQ(flight.command(kSetInterval, {attitude, 3.6e9}), kAccepted);
  flight.run(1.0);
  EXPECT_EQ(flight.command(kSetInterval, {attitude, 0}), kAccepted);
  EXPECT_NEAR(rate_hz("ATTITUDE"), 100.0, 1.0) << "at once, not in an hour";
  EXPECT_EQ(flight.command(kSetInterval, {home, 1.0}), kAccepted);
  EXPECT_NEAR(rate_hz("HOME_POSITION"), 250.0, 1.0) << "once a step";
  EXPECT_EQ(flight.command(kSetInterval, {home, 5e4}), kAccepted);
  EXPECT_EQ(flight.command(kGetInterval, {home}), kAccepted);
  EXPECT_EQ(flight.last("MESSAGE_INTERVAL")->integer("interval_us"), 50'000);
  EXPECT_EQ(flight.command(kGetInterval, {id_of("AUTOPILOT_VERSION")}), kAccepted);
  EXPECT_EQ(flight.last("MESSAGE_INTERVAL")->integer("interval_us"), -1);
  for (const double unknown : {id_of("TIMESYNC"), 65'000.0, -1.0, kNone})
    for (const int command : {kSetInterval, kGetInterval})
      EXPECT_EQ(flight.command(command, {unknown, 1e5}), kFailed) << unknown;
  EXPECT_EQ(flight.command(kSetInterval, {attitude, kNone}), kFailed);
}

TEST(Telemetry, FitsHalfOfItsLineExceptForTheHeartbeat) {
  for (const double baud : {921'600.0, 115'200.0, 57'600.0}) {
    Flight flight({.link_baud = baud});
    flight.boot();
    flight.run(2.0);
    flight.heard.clear();
    flight.run(20.0);
    double bytes_s = 0.0;
    for (const Message& m : flight.heard)
      bytes_s += static_cast<double>(m.type().length + 12) / 20.0;
    EXPECT_NEAR(static_cast<double>(flight.count("HEARTBEAT")), 20.0, 1.0) << baud;
    if (baud > 500'000.0) {
      EXPECT_NEAR(static_cast<double>(flight.count("ATTITUDE")), 2'000.0, 1.0);
    } else {
      EXPECT_NEAR(bytes_s, baud / 20.0, baud / 200.0) << baud;
    }
  }
}

TEST(Telemetry, SendsOnRequest) {
  Flight flight;
  flight.boot();
  for (const char* name : {"AUTOPILOT_VERSION", "GPS_GLOBAL_ORIGIN", "HOME_POSITION"}) {
    EXPECT_EQ(flight.command(kRequest, {id_of(name)}), kAccepted);
    EXPECT_EQ(flight.count(name), 1U);
  }
  EXPECT_EQ(flight.command(520), kAccepted);
  EXPECT_EQ(flight.count("AUTOPILOT_VERSION"), 1U);
  EXPECT_EQ(flight.command(kRequest, {id_of("PARAM_VALUE")}), kDenied);
}

TEST(Telemetry, IsInTheFramesOfMavlink) {
  Flight flight(Flight::in_air(), {0, 0, 5.0}, 0.3);
  flight.run(0.1);
  const Message to =
      target(0x0DC7 & ~1024).set("vx", 1.0).set("vy", 0.5).set("vz", -0.2).set("yaw", 0.4);
  flight.stream(to, 1.2);
  flight.mode(6);
  flight.stream(to, 4.0);
  const Message& local = *flight.last("LOCAL_POSITION_NED");
  EXPECT_NEAR(local.number("x"), flight.body.p_WB.y, 0.05);
  EXPECT_NEAR(local.number("y"), flight.body.p_WB.x, 0.05);
  EXPECT_NEAR(local.number("z"), 5.0 - flight.body.p_WB.z, 0.05);
  EXPECT_NEAR(local.number("vx"), 1.0, 0.05);
  EXPECT_NEAR(local.number("vz"), -0.2, 0.05);
  EXPECT_NEAR(flight.last("ATTITUDE")->number("yaw"), 0.4, 0.02);
  const Message& q = *flight.last("ATTITUDE_QUATERNION");
  EXPECT_NEAR(q.number("q1"), std::cos(0.2), 0.02);
  EXPECT_NEAR(q.number("q4"), std::sin(0.2), 0.02);
  const Message& global = *flight.last("GLOBAL_POSITION_INT");
  EXPECT_NEAR(global.number("lat"), flight.body.p_WB.y / 110'574.3 * 1e7, 10);
  EXPECT_NEAR(global.number("lon"), flight.body.p_WB.x / 111'319.5 * 1e7, 10);
  EXPECT_NEAR(global.number("alt"), flight.body.p_WB.z * 1e3, 30);
  EXPECT_NEAR(global.number("relative_alt"), (flight.body.p_WB.z - 5.0) * 1e3, 30);
  EXPECT_NEAR(global.number("vx"), 100, 5);
  EXPECT_NEAR(global.number("hdg"), 100.0 * 0.4 * 180.0 / std::numbers::pi, 100);
  // In the body's frame: 1 m/s to the north and 0.5 m/s to the east.
  const Message& odometry = *flight.last("ODOMETRY");
  EXPECT_NEAR(odometry.number("vx"), std::cos(0.4) + 0.5 * std::sin(0.4), 0.06);
  EXPECT_NEAR(odometry.number("vy"), -std::sin(0.4) + 0.5 * std::cos(0.4), 0.06);
  EXPECT_NEAR(flight.last("VFR_HUD")->number("groundspeed"), std::hypot(1.0, 0.5), 0.05);
  EXPECT_NEAR(flight.last("ALTITUDE")->number("altitude_relative"), flight.body.p_WB.z - 5.0, 0.1);
}

TEST(Telemetry, ShowsTheStateAndTheTime) {
  Flight flight;
  flight.boot();
  flight.run(1.0);
  const Message& heartbeat = *flight.last("HEARTBEAT");
  EXPECT_EQ(heartbeat.integer("autopilot"), 12);
  EXPECT_EQ(heartbeat.integer("type"), 2);
  EXPECT_EQ(heartbeat.integer("system_status"), 3);
  EXPECT_EQ(heartbeat.integer("base_mode") & 1, 1);
  EXPECT_EQ(flight.last("SYS_STATUS")->integer("battery_remaining"), -1) << "it has none";
  EXPECT_EQ(flight.last("SYS_STATUS")->integer("voltage_battery"), 65'535);
  EXPECT_EQ(flight.last("BATTERY_STATUS")->integer("battery_remaining"), -1);
  EXPECT_NEAR(flight.last("ATTITUDE")->number("time_boot_ms"),
              static_cast<double>(to_ns(flight.now)) / 1e6, 12);
  flight.charge = 0.55;
  flight.run(2.0);
  EXPECT_EQ(flight.last("BATTERY_STATUS")->integer("battery_remaining"), 55);
  EXPECT_EQ(flight.last("BATTERY_STATUS")->integer("voltages", 0), 15'200);
  EXPECT_EQ(flight.last("BATTERY_STATUS")->integer("voltages", 1), 65'535);
}

}  // namespace
}  // namespace tether::autopilot
