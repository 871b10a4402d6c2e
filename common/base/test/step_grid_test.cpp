#include <array>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/base/time.h>

namespace tether {
namespace {

TEST(StepGrid, RoundsDownAndUp) {
  constexpr StepGrid grid{Duration(1000)};
  for (const auto& [t, below, above] : {std::array{0, 0, 0},
                                        {1, 0, 1000},
                                        {999, 0, 1000},
                                        {1000, 1000, 1000},
                                        {3001, 3000, 4000}}) {
    EXPECT_EQ(grid.floor(from_ns<SimTime>(t)), from_ns<SimTime>(below));
    EXPECT_EQ(grid.ceil(from_ns<SimTime>(t)), from_ns<SimTime>(above));
    EXPECT_EQ(grid.contains(from_ns<SimTime>(t)), below == above);
  }
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
