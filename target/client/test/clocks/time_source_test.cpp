#include <thread>

#include <gtest/gtest.h>
#include <time.h>

#include <tether/client/sut_clock.h>

namespace tether::client {
namespace {

Duration thread_cpu() {
  timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return std::chrono::seconds(t.tv_sec) + Duration(t.tv_nsec);
}

/// Uses that much CPU time of this thread.
void compute(Duration duration) {
  const Duration end = thread_cpu() + duration;
  while (thread_cpu() < end) {
  }
}

constexpr Duration kBusy = std::chrono::milliseconds(20);

TEST(WallSource, PassesFactorTimesAsFast) {
  for (const double factor : {1.0, 8.0}) {
    const auto wall = make_wall_source();
    const auto source = make_wall_source(factor);
    EXPECT_EQ(source->clock().kind, computer::ClockKind::kWall);
    EXPECT_EQ(source->clock().factor, factor);
    const Duration wall_begin = wall->elapsed();
    const Duration begin = source->elapsed();
    compute(kBusy);
    const Duration measured = source->elapsed() - begin;
    EXPECT_GE(measured, std::int64_t(factor) * kBusy);
    EXPECT_LE(measured, std::int64_t(factor) * (wall->elapsed() - wall_begin));
  }
}

TEST(CpuSource, MeasuresComputingTimesItsFactor) {
  const auto source = make_cpu_source(8.0);
  EXPECT_EQ(source->clock().kind, computer::ClockKind::kCpu);
  EXPECT_EQ(source->clock().factor, 8.0);
  const Duration begin = source->elapsed();
  const Duration cpu_begin = thread_cpu();
  compute(kBusy);
  const Duration cpu = thread_cpu() - cpu_begin;
  const Duration measured = source->elapsed() - begin;
  EXPECT_GE(measured, 8 * kBusy);
  EXPECT_LE(measured, 8 * (cpu + kBusy));
}

TEST(CpuSource, CountsEveryThreadExceptAnExcludedOne) {
  const auto source = make_cpu_source(1.0);
  const Duration begin = source->elapsed();
  std::thread library([&source] {
    source->exclude_calling_thread();
    compute(10 * kBusy);
    source->elapsed();
    compute(10 * kBusy);
    source->release_calling_thread();
  });
  library.join();
  EXPECT_LT(source->elapsed() - begin, 10 * kBusy);
  std::thread other([] { compute(kBusy); });
  other.join();
  EXPECT_GE(source->elapsed() - begin, kBusy);
}

TEST(CpuSource, KnowsWhatOtherThreadsComputeDuringCallsAndBetweenThem) {
  const auto source = make_cpu_source(2.0);
  std::thread worker([] { compute(30ms); });  // from now on, there can be several
  worker.join();
  EXPECT_EQ(source->computed_beside(), Duration(0)) << "no call";
  EXPECT_GE(source->computed_by_others(), 60ms);
  EXPECT_LT(source->computed_by_others(), 80ms);
  source->hold();
  compute(30ms);
  source->elapsed_at_resume();
  EXPECT_LT(source->computed_beside(), 10ms) << "the thread that calls";
  source->hold();
  std::thread([] { compute(30ms); }).join();
  source->elapsed_at_resume();
  EXPECT_GE(source->computed_beside(), 60ms);
  EXPECT_LT(source->computed_beside(), 80ms);
  EXPECT_LT(source->computed_by_others(), 80ms) << "between calls";
}

TEST(CpuSource, IsMonotoneWhileAnExcludedThreadRuns) {
  const auto source = make_cpu_source(1.0);
  std::thread library([&source] {
    source->exclude_calling_thread();
    compute(2 * kBusy);
    source->release_calling_thread();
  });
  Duration last = source->elapsed();
  const Duration end = thread_cpu() + 3 * kBusy;
  while (thread_cpu() < end) {
    const Duration now = source->elapsed();
    ASSERT_GE(now, last);
    last = now;
  }
  library.join();
  EXPECT_GE(source->elapsed(), last);
}

TEST(ScriptedSource, MovesByItsStepAtEachReading) {
  const auto source = make_scripted_source(std::chrono::milliseconds(12));
  EXPECT_EQ(source->clock().kind, computer::ClockKind::kScripted);
  SutClock clock(*source, from_ns<ExecTime>(0));
  for (int i = 0; i < 3; ++i) {
    const ExecTime stamp = clock.hold();
    EXPECT_EQ(stamp.time_since_epoch(), std::chrono::milliseconds(12 + 112 * i));
    clock.resume(stamp + std::chrono::milliseconds(100));
  }
}

}  // namespace
}  // namespace tether::client
