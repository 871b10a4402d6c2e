#include <gtest/gtest.h>

#include <tether/sim/simulator_work.h>

namespace tether::sim {
namespace {

TEST(CpuTimer, MeasuresWhatTheThreadComputes) {
  const CpuTimer timer;
  Duration last{0};
  while (last < std::chrono::milliseconds(2)) {  // ends only if the time grows
    const Duration now = timer.elapsed();
    ASSERT_GE(now, last);
    last = now;
  }
}

}  // namespace
}  // namespace tether::sim
