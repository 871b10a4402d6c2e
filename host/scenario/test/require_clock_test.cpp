#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
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

TEST(RequireClock, LetsASerialProgramBeMeasuredByAnyClock) {
  for (const Clock clock : {Clock::kWall, Clock::kCpu, Clock::kScripted})
    EXPECT_NO_THROW(require_clock(with_sut(false), with_clock(clock)));
}

TEST(RequireClock, LetsAConcurrentProgramBeMeasuredByTheWallClockOnly) {
  EXPECT_NO_THROW(require_clock(with_sut(true), with_clock(Clock::kWall)));
  for (const Clock clock : {Clock::kCpu, Clock::kScripted})
    EXPECT_THAT(error_message(ErrorCode::kBadFile,
                              [&] { require_clock(with_sut(true), with_clock(clock)); }),
                testing::AllOf(testing::HasSubstr("/s/hover.toml"), testing::HasSubstr("\"uav2\""),
                               testing::HasSubstr("\"board\"")));
}

}  // namespace
}  // namespace tether::scenario
