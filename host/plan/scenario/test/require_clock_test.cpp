#include "test_files.h"

#include <gtest/gtest.h>

#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

TEST(RequireClock, RefusesAllButTheWallClockForAConcurrentProgram) {
  Scenario scenario;
  scenario.file = "/s/hover.toml";
  scenario.uavs.resize(2);
  scenario.uavs[1].placement.name = "uav2";
  Condition condition;
  for (const computer::ClockKind clock :
       {computer::ClockKind::kWall, computer::ClockKind::kCpu, computer::ClockKind::kScripted}) {
    condition.computers[0].clock.kind = clock;
    scenario.uavs[1].sut.concurrent = false;
    EXPECT_NO_THROW(require_clock(scenario, condition));
    scenario.uavs[1].sut.concurrent = true;
    if (clock != computer::ClockKind::kWall)
      expect_refusal(0, "uav2", [&] { require_clock(scenario, condition); });
  }
  condition.computers[0].clock.kind = computer::ClockKind::kWall;
  EXPECT_NO_THROW(require_clock(scenario, condition));
}

TEST(RequireClock, RefusesEmulatorsAndTheScriptedClockForAProgramAsItIs) {
  Scenario scenario;
  scenario.file = "/s/square.toml";
  scenario.uavs.resize(1);
  scenario.uavs[0].placement.name = "uav1";
  scenario.uavs[0].sut.is_as_is = true;
  Condition condition;
  condition.computers[0].clock.kind = computer::ClockKind::kCpu;
  EXPECT_NO_THROW(require_clock(scenario, condition));
  condition.computers[0].clock.kind = computer::ClockKind::kScripted;
  expect_refusal(0, "uav1", [&] { require_clock(scenario, condition); });
  condition.computers[0].clock.kind = computer::ClockKind::kCpu;
  condition.computers[0].target.emplace();
  EXPECT_NO_THROW(require_clock(scenario, condition));
  condition.computers[0].target->program_folder = "/opt/arm";
  expect_refusal(0, "uav1", [&] { require_clock(scenario, condition); });
}

TEST(RequireClock, ProcessesOfOneProgramNeedAMeasuredClockAndSynchronisation) {
  Scenario scenario;
  scenario.file = "/s/ros.toml";
  scenario.uavs.resize(1);
  scenario.uavs[0].placement.name = "uav1";
  scenario.uavs[0].sut.is_as_is = scenario.uavs[0].sut.has_all_processes = true;
  Condition condition;
  condition.computers[0].clock.kind = computer::ClockKind::kCpu;
  EXPECT_NO_THROW(require_clock(scenario, condition));
  condition.policy = Policy::kFreeRunning;
  expect_refusal(0, "uav1", [&] { require_clock(scenario, condition); });
  condition.policy = Policy::kConservativeBarrier;
  condition.computers[0].clock.kind = computer::ClockKind::kWall;
  EXPECT_NO_THROW(require_clock(scenario, condition));
  condition.computers[0].clock.kind = computer::ClockKind::kCounted;
  expect_refusal(0, "uav1", [&] { require_clock(scenario, condition); });
}

}  // namespace
}  // namespace tether::scenario
