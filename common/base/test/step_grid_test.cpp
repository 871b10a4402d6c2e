#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/base/step_grid.h>

namespace tether {
namespace {

TEST(StepGrid, RoundsDownAndUp) {
  constexpr StepGrid grid{Duration(1000)};
  static_assert(grid.floor(from_ns<SimTime>(0)) == from_ns<SimTime>(0));
  static_assert(grid.ceil(from_ns<SimTime>(0)) == from_ns<SimTime>(0));
  static_assert(grid.floor(from_ns<SimTime>(1)) == from_ns<SimTime>(0));
  static_assert(grid.ceil(from_ns<SimTime>(1)) == from_ns<SimTime>(1000));
  static_assert(grid.floor(from_ns<SimTime>(999)) == from_ns<SimTime>(0));
  static_assert(grid.ceil(from_ns<SimTime>(999)) == from_ns<SimTime>(1000));
  static_assert(grid.floor(from_ns<SimTime>(1000)) == from_ns<SimTime>(1000));
  static_assert(grid.ceil(from_ns<SimTime>(1000)) == from_ns<SimTime>(1000));
  static_assert(grid.contains(from_ns<SimTime>(3000)) && !grid.contains(from_ns<SimTime>(3001)));
}

TEST(StepGrid, BracketsEveryInstantWithinOneStep) {
  KeyedRandom random({.seed = 1});
  for (int i = 0; i < 10'000; ++i) {
    const StepGrid grid{Duration(1 + random.bits() % 10'000'000)};
    const auto t =
        from_ns<SimTime>(static_cast<std::int64_t>(random.bits()) * 1000 + random.bits() % 1000);
    const SimTime below = grid.floor(t), above = grid.ceil(t);
    ASSERT_LE(below, t);
    ASSERT_GE(above, t);
    ASSERT_LT(t - below, grid.dt());
    ASSERT_LT(above - t, grid.dt());
    ASSERT_TRUE(grid.contains(below) && grid.contains(above));
    ASSERT_EQ(below == above, grid.contains(t));
  }
}

}  // namespace
}  // namespace tether
