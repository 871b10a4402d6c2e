#include "stepper.h"

#include "scripted_server.h"

#include <gtest/gtest.h>

#include <tether/sim_testing/fake_simulator.h>

namespace tether::coordinator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

SimTime st_ms(std::int64_t value) {
  return SimTime(milliseconds(value));
}

TEST(Stepper, ACommandTakesEffectAtTheFirstBoundaryFromItsTimeOn) {
  sim::FakeSimulator simulator(sim::make_fake_world(1));
  MemoryRecorder recorder;
  RunLog log(recorder);
  RunOptions options;
  options.uavs.resize(1);
  const Timelines times(options, simulator.grid());
  Stepper stepper(simulator, times, log, milliseconds(10), {Sampler({}, simulator.grid())},
                  {std::nullopt});
  stepper.act();
  const std::pair<int, int> cases[] = {{0, 0}, {1'000, 1}, {1'001, 2}, {2'999, 3}};  // us, st_ms
  for (const auto& [t, effect] : cases)
    EXPECT_EQ(simulator.grid().ceil(stepper.command({SimTime(microseconds(t)), 0, 7, {{}}})),
              st_ms(effect));
  EXPECT_EQ(stepper.waiting_setpoints(0), 4u);
  EXPECT_EQ(stepper.next_due(), st_ms(0));
  stepper.act();
  for (int i = 1; i <= 3; ++i) {
    EXPECT_EQ(stepper.next_due(), st_ms(i));
    stepper.advance_to(st_ms(i));
  }
  EXPECT_EQ(stepper.waiting_setpoints(0), 0u);
  ASSERT_EQ(recorder.commands.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(simulator.applied()[i].at, st_ms(cases[i].second));
    EXPECT_EQ(recorder.commands[i].applied_at, st_ms(cases[i].second));
  }
}

}  // namespace
}  // namespace tether::coordinator
