#include "stepper.h"

#include "scripted_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/sim_testing/fake_simulator.h>

namespace tether::coordinator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

SimTime ms(std::int64_t value) {
  return SimTime(milliseconds(value));
}

/// One UAV whose camera measures every 33 ms; ground truth every 10 ms.
class Stepping : public testing::Test {
 protected:
  Stepping() { barrier_.add(ExecTime{}); }
  void advance_to(SimTime to) {
    while (stepper_.st() < to) stepper_.advance_to(std::min(to, stepper_.next_due()));
  }

  sim::FakeSimulator simulator_{sim::make_fake_world(1)};
  MemoryRecorder recorder_;
  RunLog log_{recorder_};
  sync::BarrierSynchronizer barrier_{simulator_.grid()};
  Stepper stepper_{
      simulator_,
      barrier_,
      log_,
      milliseconds(10),
      {Sampler({{"camera",
                 {uav::PeriodicTiming{milliseconds(33), Duration(0), uav::ConstantDelay{}}, 0, 0}}},
               simulator_.grid(), true)}};
};

TEST_F(Stepping, StopsAtEachDueEventAndActsOnce) {
  stepper_.act();
  stepper_.act();
  EXPECT_EQ(recorder_.ground_truth.size(), 1u);
  EXPECT_EQ(stepper_.next_due(), ms(10));
  advance_to(ms(30));
  EXPECT_EQ(stepper_.next_due(), ms(33));
  EXPECT_EQ(recorder_.ground_truth.size(), 4u);
  EXPECT_EQ(recorder_.ground_truth.back().at, ms(30));
}

TEST_F(Stepping, ACommandTakesEffectAtTheFirstBoundaryFromItsTimeOn) {
  stepper_.act();
  const std::pair<int, int> cases[] = {{0, 0}, {1'000, 1}, {1'001, 2}, {2'999, 3}};  // us, ms
  for (const auto& [t, effect] : cases)
    EXPECT_EQ(stepper_.command(0, 7, {}, SimTime(microseconds(t))), ms(effect));
  EXPECT_EQ(stepper_.waiting_commands(0), 4u);
  EXPECT_EQ(stepper_.next_due(), ms(0));
  stepper_.act();
  EXPECT_EQ(stepper_.next_due(), ms(1));
  advance_to(ms(3));
  EXPECT_EQ(stepper_.waiting_commands(0), 0u);
  ASSERT_EQ(recorder_.commands.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(simulator_.applied()[i].at, ms(cases[i].second));
    EXPECT_EQ(recorder_.commands[i].applied_at, ms(cases[i].second));
  }
}

TEST_F(Stepping, AReadGetsTheStateOfItsSamplingInstant) {
  stepper_.act();
  advance_to(ms(40));
  record::Interaction entry;
  entry.sequence = 1;
  EXPECT_FALSE(stepper_.measure(0, entry));
  ASSERT_TRUE(stepper_.sampler(0).plan(1, {}, ms(40)));
  EXPECT_TRUE(stepper_.measure(0, entry));
  EXPECT_EQ(entry.sample_state_at, ms(33));
  EXPECT_EQ(simulator_.calls().measure, 1u);
}

TEST_F(Stepping, ErrorsOfTheSimulatorAreSimulatorFailures) {
  simulator_.on_advance([](SimTime, SimTime) { throw Error(ErrorCode::kSetup, "crashed"); });
  EXPECT_THROW(stepper_.advance_to(ms(1)), SimulatorFailure);
  EXPECT_EQ(stepper_.st(), ms(0));
}

}  // namespace
}  // namespace tether::coordinator
