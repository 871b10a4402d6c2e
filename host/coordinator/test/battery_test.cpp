#include "coordinator_fixture.h"

#include <algorithm>

#include <gtest/gtest.h>

#include <tether/energy/meter.h>

namespace tether::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using CoordinatorBattery = CoordinatorTest;

sim::World world_with_battery(double charge) {
  sim::World world = sim::make_fake_world(1);
  world.uavs[0].airframe = uav::hummingbird();
  energy::Model& model = world.uavs[0].energy.emplace();
  model.propulsion = {.rotor_radius_m = 0.1, .efficiency = 0.7, .nominal_voltage_V = 11.1};
  model.battery = {.capacity_C = 7200.0,
                   .voltage_at_charge = {{0.0, 10.0}, {1.0, 12.0}},
                   .resistance_ohm = 0.05,
                   .cut_off_V = 9.0,
                   .initial_charge = charge};
  model.computer = {.idle_W = 2.0, .busy_core_W = 10.0};
  return world;
}

// What it waits and sleeps costs idle power only.
TEST_F(CoordinatorBattery, ChargesTheBatteryForWhatTheSutComputes) {
  make(world_with_battery(1.0));
  run({sleep(milliseconds(20), milliseconds(100)), sleep(milliseconds(30), milliseconds(100)),
       finish(Duration(0))});
  ASSERT_FALSE(recorder_.batteries.empty());
  const record::Battery& last = recorder_.batteries.back();
  EXPECT_EQ(last.at, st_ms(250));
  EXPECT_NEAR(last.idle_J, 0.25 * 2.0, 1e-9);
  EXPECT_NEAR(last.computing_J, 0.05 * 10.0, 1e-9);
  EXPECT_EQ(recorder_.batteries.size(), recorder_.ground_truth.size());
}

TEST_F(CoordinatorBattery, EndsTheRunSomeTimeAfterABatteryWasEmpty) {
  make(world_with_battery(0.0001));
  const RunReport report = run({sleep(Duration(0), seconds(20)), finish(Duration(0))});
  EXPECT_EQ(report.end, RunEnd::kBatteryEmpty);
  EXPECT_EQ(recorder_.footer->end, "battery_empty");
  EXPECT_GT(report.st, st_ms(2000));
  EXPECT_LT(report.st, st_ms(3000));
}

// What it computes until its call is drawn after it.
TEST_F(CoordinatorBattery, ReadsTheBatteryAtTheBoundaryOfTheReply) {
  make(world_with_battery(0.5));
  run({{std::chrono::microseconds(20'400), link::ReadBattery{}}, finish(milliseconds(20))});
  const auto& sent = server_->sent.at(1);
  EXPECT_EQ(std::get<link::Welcome>(sent.at(0)).catalogue.battery_capacity_C, 7200.0);
  const auto reply = std::get<link::Reply>(sent.at(1));
  ASSERT_TRUE(reply.battery);
  EXPECT_EQ(reply.resume_at, us(20'400));
  EXPECT_EQ(reply.battery->sampled_at, st_ms(20));
  const auto logged = std::ranges::find(recorder_.batteries, st_ms(20), &record::Battery::at);
  ASSERT_NE(logged, recorder_.batteries.end());
  const record::Interaction& read = recorder_.interactions.at(0);
  EXPECT_EQ(read.kind, record::kBattery);
  EXPECT_EQ(read.battery,
            (record::BatteryReading{logged->voltage_V, logged->current_A, logged->charge}));
  EXPECT_EQ(*reply.battery,
            (uav::BatterySample{st_ms(20), logged->voltage_V, logged->current_A, logged->charge}));
  EXPECT_LT(logged->charge, 0.5);
}

TEST_F(CoordinatorBattery, RefusesToReadABatteryThatIsNotThere) {
  const RunReport report = run({{milliseconds(1), link::ReadBattery{}}});
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_EQ(std::get<link::Welcome>(server_->sent.at(1).at(0)).catalogue.battery_capacity_C, 0.0);
  EXPECT_EQ(refusal(1).reason, link::Refusal::Reason::kBadRequest);
}

TEST_F(CoordinatorBattery, WritesNoBatteryWithoutAModelOfEnergy) {
  run({finish(milliseconds(20))});
  EXPECT_TRUE(recorder_.batteries.empty());
}

}  // namespace
}  // namespace tether::coordinator
