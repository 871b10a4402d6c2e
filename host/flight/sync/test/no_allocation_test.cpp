#include <gtest/gtest.h>

#include <tether/base_testing/allocation_count.h>
#include <tether/sync/barrier_synchronizer.h>

namespace tether::sync {
namespace {

constexpr Duration kDt = std::chrono::milliseconds(1);

ExecTime at(std::int64_t step) {
  return ExecTime(step * kDt);
}

// Serial and concurrent SUTs, all of whose calls are open at once.
TEST(NoAllocation, TheBarrierAllocatesOnlyWhereSutsJoin) {
  if (!AllocationCount::is_possible()) GTEST_SKIP() << "a sanitizer's allocator";
  BarrierSynchronizer barrier{StepGrid(kDt)};
  const SutIndex serial = barrier.add(ExecTime{});
  const SutIndex concurrent = barrier.add(ExecTime{}, SutKind::kConcurrent);
  std::uint64_t released = 0;
  SimTime st{};

  AllocationCount count;
  for (std::int64_t round = 0; round < 100; ++round) {
    const ExecTime now = at(100 * round), due = at(100 * round + 50);
    barrier.arrive(serial, now, st);
    barrier.hold({serial, due, 1});
    for (CallId call = 0; call < kMaxOpenCalls; ++call) {
      barrier.arrive(concurrent, now, st);
      barrier.hold({concurrent, due, call});
    }
    barrier.progress(concurrent, now + kDt);
    barrier.stop(concurrent, due);
    st = barrier.lower_bound();
    while (barrier.release(st)) ++released;
    barrier.progress(serial, at(100 * round + 100));
    barrier.progress(concurrent, at(100 * round + 100));
    st = barrier.lower_bound();
  }
  EXPECT_EQ(count.stop(), 0);
  EXPECT_EQ(released, 100 * (1 + kMaxOpenCalls));
}

}  // namespace
}  // namespace tether::sync
