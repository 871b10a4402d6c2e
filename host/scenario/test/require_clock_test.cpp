#include "test_files.h"

#include <gtest/gtest.h>

#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

Scenario with_sut(bool concurrent) {
  Scenario scenario;
  scenario.file = "/s/hover.toml";
  scenario.uavs.resize(2);
  scenario.uavs[1].placement.name = "uav2";
  scenario.uavs[1].sut.concurrent = concurrent;
  return scenario;
}

Condition with_clock(Clock clock) {
  Condition condition;
  condition.name = "board";
  condition.clock = clock;
  return condition;
}

TEST(RequireClock, AllowsAnyClockForASerialProgram) {
  for (const Clock clock : {Clock::kWall, Clock::kCpu, Clock::kScripted})
    EXPECT_NO_THROW(require_clock(with_sut(false), with_clock(clock)));
}

TEST(RequireClock, AllowsOnlyTheWallClockForAConcurrentProgram) {
  EXPECT_NO_THROW(require_clock(with_sut(true), with_clock(Clock::kWall)));
  for (const Clock clock : {Clock::kCpu, Clock::kScripted})
    expect_refusal(0, "uav2", [&] { require_clock(with_sut(true), with_clock(clock)); });
}

}  // namespace
}  // namespace tether::scenario
