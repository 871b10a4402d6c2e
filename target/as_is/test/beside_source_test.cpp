#include "beside_source.h"

#include "threads.h"

#include <ctime>
#include <thread>

#include <gtest/gtest.h>

#include <tether/os/machine.h>

namespace tether::as_is {
namespace {

using std::chrono::milliseconds;

void compute_for(Duration time) {
  const Duration begun = os::read_clock(CLOCK_THREAD_CPUTIME_ID);
  while (os::read_clock(CLOCK_THREAD_CPUTIME_ID) - begun < time) {
  }
}

constexpr ExecTime kReply = ExecTime(std::chrono::seconds(1));

class AsIsBesideSource : public testing::Test {
 protected:
  std::unique_ptr<client::TimeSource> source_ = charge_beside_calls(client::make_cpu_source(2.0));
};

TEST_F(AsIsBesideSource, WhatACallComputesItselfIsFree) {
  client::SutClock clock(*source_);
  clock.hold();
  compute_for(milliseconds(20));
  clock.resume(kReply);
  EXPECT_GE(clock.now(), kReply);
  EXPECT_LT(clock.now(), kReply + milliseconds(5));
}

TEST_F(AsIsBesideSource, WhatAnotherThreadComputesDuringACallIsChargedAfterIt) {
  Threads::began();
  client::SutClock clock(*source_);
  clock.hold();
  std::thread([] { compute_for(milliseconds(20)); }).join();
  compute_for(milliseconds(20));
  clock.resume(kReply);
  EXPECT_GE(clock.now(), kReply + milliseconds(40));
  EXPECT_LT(clock.now(), kReply + milliseconds(60));
  Threads::ended();
}

TEST_F(AsIsBesideSource, TimeDoesNotGoBackWhoeverCalls) {
  Threads::began();
  client::SutClock clock(*source_);
  ExecTime last{};
  const auto call = [&] {
    for (int i = 0; i < 1000; ++i) {
      const ExecTime at = clock.hold();
      ASSERT_GE(at, last);
      clock.resume(at);
      last = clock.now();
      ASSERT_GE(last, at);
    }
  };
  call();
  std::thread(call).join();
  call();
  Threads::ended();
}

TEST_F(AsIsBesideSource, OfAWallClockItIsOnlyKnown) {
  const auto wall = charge_beside_calls(client::make_wall_source());
  client::SutClock clock(*wall);
  const Duration before = computed_beside_calls();
  const auto beside = [&] { return computed_beside_calls() - before; };
  clock.hold();
  compute_for(milliseconds(20));
  clock.resume(kReply);
  EXPECT_LT(clock.now(), kReply + milliseconds(10));
  EXPECT_LT(beside(), milliseconds(10)) << "the thread that calls";
  std::thread([] { compute_for(milliseconds(20)); }).join();
  EXPECT_LT(beside(), milliseconds(10)) << "no call is open";
  clock.hold();
  std::thread([] { compute_for(milliseconds(20)); }).join();
  clock.resume(kReply + std::chrono::seconds(1));
  EXPECT_GE(beside(), milliseconds(20));
  EXPECT_LT(clock.now(), kReply + milliseconds(1010));
}

TEST_F(AsIsBesideSource, OtherClocksAreLeftAsTheyAre) {
  auto scripted = client::make_scripted_source(milliseconds(1));
  const client::TimeSource* const same = scripted.get();
  EXPECT_EQ(charge_beside_calls(std::move(scripted)).get(), same);
}

}  // namespace
}  // namespace tether::as_is
