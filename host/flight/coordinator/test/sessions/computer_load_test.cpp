#include "sessions/computer_load.h"

#include <gtest/gtest.h>

namespace tether::coordinator {
namespace {

constexpr SimTime at_us(std::int64_t value) {
  return SimTime(std::chrono::microseconds(value));
}
const StepGrid kMilliseconds{std::chrono::milliseconds(1)};

TEST(ComputerLoad, IsTheShareOfEachStepInWhichItComputes) {
  ComputerLoad load;
  load.begin(at_us(1'250));
  EXPECT_EQ(load.next_change(at_us(0), kMilliseconds), at_us(1'000));
  EXPECT_EQ(load.next_change(at_us(1'000), kMilliseconds), at_us(2'000));
  EXPECT_EQ(load.next_change(at_us(2'000), kMilliseconds), SimTime::max()) << "until it ends";
  EXPECT_EQ(load.mean_cores(at_us(0), at_us(1'000)), 0.0);
  EXPECT_EQ(load.mean_cores(at_us(1'000), at_us(2'000)), 0.75);
  EXPECT_EQ(load.mean_cores(at_us(2'000), at_us(66'000)), 1.0);
  load.end(at_us(70'500));
  load.begin(at_us(70'900));
  load.end(at_us(71'000));
  EXPECT_EQ(load.next_change(at_us(66'000), kMilliseconds), at_us(70'000));
  EXPECT_DOUBLE_EQ(load.mean_cores(at_us(70'000), at_us(71'000)), 0.6);
  EXPECT_EQ(load.next_change(at_us(71'000), kMilliseconds), SimTime::max());
  EXPECT_EQ(load.mean_cores(at_us(71'000), at_us(80'000)), 0.0);
}

TEST(ComputerLoad, AShareOfACoreIsExactHoweverLongTheTime) {
  ComputerLoad load;
  const double share = 1.0 / 3.0;
  load.add(at_us(0), at_us(500), share);
  load.add(at_us(500), at_us(64'000), share);
  EXPECT_EQ(load.next_change(at_us(0), kMilliseconds), at_us(64'000))
      << "a call that takes no time is no edge";
  EXPECT_EQ(load.mean_cores(at_us(0), at_us(1'000)), share);
  EXPECT_EQ(load.mean_cores(at_us(1'000), at_us(64'000)), share);
}

TEST(ComputerLoad, WhatEndsBeforeItBeginsIsNothing) {
  ComputerLoad load;
  load.end(at_us(5));
  load.begin(at_us(1'000));
  load.end(at_us(900));
  EXPECT_EQ(load.next_change(at_us(0), kMilliseconds), SimTime::max());
  EXPECT_EQ(load.mean_cores(at_us(0), at_us(2'000)), 0.0);
}

}  // namespace
}  // namespace tether::coordinator
