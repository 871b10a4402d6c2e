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

// Whatever the speed of the simulator, and however far it is ahead when the caller looks.
TEST_F(CoordinatorBattery, EndsTheRunSomeStepsAfterTheCallerKilledIt) {
  std::vector<SimTime> ends_at;
  for (const double real_time_factor : {0.0, 0.5}) {
    options_.real_time_factor = real_time_factor;
    make();
    hooks_.killed = [this]() -> std::optional<std::pair<SimTime, std::string>> {
      for (const record::GroundTruth& truth : recorder_.ground_truth)
        if (truth.at >= st_ms(50)) return std::pair(truth.at, std::string("beyond the fence"));
      return std::nullopt;
    };
    server_->add_sut(hello(), {sleep(Duration(0), seconds(20)), finish(Duration(0))});
    const RunReport report = run();
    EXPECT_EQ(report.end, RunEnd::kKilled);
    EXPECT_EQ(report.reason, "beyond the fence");
    EXPECT_EQ(recorder_.footer->end, "killed");
    EXPECT_EQ(report.st, recorder_.footer->st_at_end);
    EXPECT_GT(report.st, st_ms(50));
    ends_at.push_back(report.st);
  }
  EXPECT_EQ(ends_at[0], ends_at[1]);
}

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
  EXPECT_NEAR(logged->computing_J, 0.02 * 10.0, 1e-9) << "what it computed until ST 20 ms";
}

TEST_F(CoordinatorBattery, ChargesWhatIsComputedWhileItIsComputedUpToTheEnd) {
  make(world_with_battery(1.0));
  run({sleep(milliseconds(20), milliseconds(100)), finish(milliseconds(80))});
  const auto computed_J = [&](std::int64_t ms) {
    return std::ranges::find(recorder_.batteries, st_ms(ms), &record::Battery::at)->computing_J;
  };
  EXPECT_NEAR(computed_J(10), 0.1, 1e-9);
  EXPECT_NEAR(computed_J(120), 0.2, 1e-9);
  EXPECT_NEAR(computed_J(200), 1.0, 1e-9) << "before `finish`, too";
}

TEST_F(CoordinatorBattery, ChargesWhatIsComputedUntilTheTimeLimit) {
  options_.time_limit = milliseconds(100);
  make(world_with_battery(1.0));
  EXPECT_EQ(run({sleep(milliseconds(20), milliseconds(10)), finish(milliseconds(500))}).end,
            RunEnd::kTimeLimit);
  EXPECT_EQ(recorder_.batteries.back().at, st_ms(100));
  EXPECT_NEAR(recorder_.batteries.back().computing_J, 0.09 * 10.0, 1e-9);
}

TEST_F(CoordinatorBattery, ChargesEachUavOfASharedBoardForItsShareOfTheCores) {
  sim::World world = world_with_battery(1.0);
  world.uavs.push_back(world.uavs[0]);
  world.uavs[1].name = "other";
  options_.boards = {{"obc", 1}};
  make(world);
  for (UavOptions& uav : options_.uavs) {
    uav.board = 0;
    uav.clock = computer::Clock{.kind = computer::ClockKind::kScripted};
  }
  remake();
  server_->add_sut(hello(world.uavs[0].name), {finish(milliseconds(30))});
  server_->add_sut(hello("other"), {finish(milliseconds(60))});
  ASSERT_EQ(run().end, RunEnd::kFinished);
  for (const record::Battery& battery : recorder_.batteries) {
    const double s = to_seconds(battery.at);
    const bool is_first = battery.uav == world.uavs[0].name;
    EXPECT_NEAR(battery.computing_J,
                10.0 * (is_first ? std::min(s, 0.06) / 2 : std::max(s / 2, s - 0.03)), 1e-9)
        << s;
  }
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
