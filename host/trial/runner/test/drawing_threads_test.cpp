#include "drawing_threads.h"

#include <gtest/gtest.h>

#include <tether/sim_testing/fake_simulator.h>

namespace tether::runner {
namespace {

using computer::ClockKind;
using scenario::Policy;

TEST(DrawingThreads, AreNoneWhereTheyCouldDistortTheTimeOfTheProgram) {
  struct Case {
    const char* what;
    ClockKind clock;
    bool on_board, waits;
    Policy policy;
    int threads;
  };
  constexpr Policy kBarrier = Policy::kConservativeBarrier;
  const Case cases[] = {
      {"CPU time", ClockKind::kCpu, false, false, kBarrier, 1},
      {"counted instructions", ClockKind::kCounted, false, false, kBarrier, 1},
      {"a script", ClockKind::kScripted, false, false, kBarrier, 1},
      {"wall time of this machine", ClockKind::kWall, false, false, kBarrier, 0},
      {"wall time of a board", ClockKind::kWall, true, false, kBarrier, 1},
      {"wall time of any machine", ClockKind::kWall, false, true, kBarrier, 0},
      {"wall time, started by the user", ClockKind::kWall, true, true, kBarrier, 0},
      {"the coordinator's time", ClockKind::kUnstamped, true, false, kBarrier, 0},
      {"free running", ClockKind::kCpu, false, false, Policy::kFreeRunning, 0},
  };
  const sim::World world = sim::make_fake_world(4);
  for (const Case& c : cases) {
    SCOPED_TRACE(c.what);
    TrialSpec spec;
    spec.scenario.uavs.resize(1);
    spec.condition.computers[0].clock.kind = c.clock;
    spec.condition.policy = c.policy;
    spec.waits_for_sut = c.waits;
    if (c.on_board) spec.condition.computers[0].target.emplace().ssh.emplace();
    EXPECT_EQ(drawing_threads(spec, world, 2), c.threads);
  }
}

TEST(DrawingThreads, LeaveACoreToTheProgramAndAreNoMoreThanCameras) {
  const TrialSpec spec;
  const auto threads = [&](std::size_t cameras, int cores) {
    return drawing_threads(spec, sim::make_fake_world(cameras), cores);
  };
  EXPECT_EQ(threads(1, 1), 0);
  EXPECT_EQ(threads(1, 16), 1);
  EXPECT_EQ(threads(4, 3), 2);
  EXPECT_EQ(threads(0, 4), 0);
}

}  // namespace
}  // namespace tether::runner
