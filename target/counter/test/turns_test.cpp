#include "turns.h"

#include <future>
#include <thread>

#include <gtest/gtest.h>

namespace tether::counter {
namespace {

using enum SystemCall;
using namespace std::chrono_literals;

constexpr auto kLimit = 10s;

/// A program with threads 0 and 1 in flight: 0 computes, 1 waits.
class TurnsTest : public ::testing::Test {
 protected:
  explicit TurnsTest(std::chrono::milliseconds longest_short_call = 1h)
      : turns_(page_, longest_short_call) {
    turns_.begins(0);
    turns_.begins(1);
    turns_.enters_kernel(1, kWaits);
    page_.watched.store(1);
  }

  CountFault fault() const { return static_cast<CountFault>(page_.fault.load()); }
  std::future<void> leaves(unsigned thread) {
    return std::async(std::launch::async, [this, thread] { turns_.leaves_kernel(thread, 0); });
  }
  /// Thread 0 wakes thread 1, which then queues.
  std::future<void> wake() {
    turns_.enters_kernel(0, kWakes);
    auto woken = leaves(1);
    turns_.leaves_kernel(0, 1);
    return woken;
  }
  static bool has_returned(const std::future<void>& call) {
    return call.wait_for(0s) == std::future_status::ready;
  }
  void compute(double us) { page_.units += static_cast<std::uint64_t>(us * 1e3 * kCostUnitsPerNs); }

  CountPage page_;
  Turns turns_;
};

class ShortCall : public TurnsTest {
 protected:
  ShortCall() : TurnsTest(1ms) {}
};

TEST_F(TurnsTest, AWokenThreadComputesWhenItsWakerWaits) {
  auto woken = wake();
  EXPECT_EQ(page_.computing.load(), 2u);
  compute(90);
  turns_.enters_kernel(0, kShort);
  turns_.leaves_kernel(0, 0);
  EXPECT_FALSE(has_returned(woken));
  turns_.enters_kernel(0, kWaits);
  ASSERT_EQ(woken.wait_for(kLimit), std::future_status::ready);
  EXPECT_EQ(fault(), CountFault::kNone);
}

TEST_F(TurnsTest, ComputingBesideAWokenThreadIsAFault) {
  auto woken = wake();
  compute(110);
  turns_.enters_kernel(0, kWaits);
  ASSERT_EQ(woken.wait_for(kLimit), std::future_status::ready);
  EXPECT_EQ(fault(), CountFault::kThreads);
}

TEST_F(TurnsTest, AFaultLetsAllThreadsCompute) {
  auto woken = wake();
  compute(110);
  ASSERT_EQ(woken.wait_for(kLimit), std::future_status::ready) << "though the other one computes";
  EXPECT_EQ(fault(), CountFault::kThreads);
}

TEST_F(TurnsTest, AnotherThreadMustNotComputeWhileTheProgramIsHeld) {
  page_.held.store(1);
  turns_.enters_kernel(0, kWaits);
  turns_.leaves_kernel(0, 0);
  EXPECT_EQ(fault(), CountFault::kNone) << "the calling thread";
  turns_.enters_kernel(0, kWaits);
  turns_.leaves_kernel(1, 0);
  EXPECT_EQ(fault(), CountFault::kThreads);
}

TEST_F(TurnsTest, AStartedThreadComputesToItsFirstSystemCallAndThenQueues) {
  turns_.enters_kernel(0, kStartsThread);
  turns_.begins(2);
  auto starter = leaves(0);
  EXPECT_FALSE(has_returned(starter));
  turns_.enters_kernel(2, kShort);
  ASSERT_EQ(starter.wait_for(kLimit), std::future_status::ready);
  auto started = leaves(2);
  turns_.enters_kernel(0, kWaits);
  ASSERT_EQ(started.wait_for(kLimit), std::future_status::ready);
  EXPECT_EQ(fault(), CountFault::kNone);
}

TEST_F(ShortCall, LetsAnotherThreadComputeIfItLasts) {
  turns_.enters_kernel(0, kShort);  // writes to a pipe that is full
  auto reader = leaves(1);
  ASSERT_EQ(reader.wait_for(kLimit), std::future_status::ready);
  EXPECT_EQ(fault(), CountFault::kNone);
}

TEST_F(TurnsTest, AStartedProcessIsAFaultInFlightOnly) {
  turns_.enters_kernel(0, kStartsProcess);
  EXPECT_EQ(fault(), CountFault::kProcess);
  page_.fault.store(0);
  page_.watched.store(0);
  turns_.enters_kernel(0, kStartsProcess);
  EXPECT_EQ(fault(), CountFault::kNone);
}

TEST_F(TurnsTest, WaitingByTheMachinesClockIsAFault) {
  const auto read_clock = [&](int times) {
    for (int i = 0; i < times; ++i) turns_.enters_kernel(0, kReadsClock), leaves(0).wait();
  };
  read_clock(900);
  page_.held.store(1);
  turns_.enters_kernel(0, kWaits);
  leaves(0).wait();
  page_.held.store(0);
  read_clock(1000);
  EXPECT_EQ(fault(), CountFault::kNone) << "900 of them were before the last call";
  read_clock(1);
  EXPECT_EQ(fault(), CountFault::kClock);
}

TEST_F(TurnsTest, ThreadsAreFreeBeforeTheFlight) {
  page_.watched.store(0);
  turns_.leaves_kernel(1, 0);
  EXPECT_EQ(page_.computing.load(), 2u);
  compute(1000);
  turns_.enters_kernel(0, kWaits);
  EXPECT_EQ(page_.computing.load(), 1u);
  EXPECT_EQ(fault(), CountFault::kNone);
}

}  // namespace
}  // namespace tether::counter
