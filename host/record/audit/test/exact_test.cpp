#include "exact.h"

#include <limits>

#include <gtest/gtest.h>

namespace tether::audit {
namespace {

TEST(Boundaries, RoundTowardsEitherSideForAnySign) {
  const Boundaries grid(Duration(10));
  for (int t = -100; t <= 100; ++t) {
    const Wide before = grid.at_or_before(t);
    const Wide after = grid.at_or_after(t);
    EXPECT_TRUE(grid.contain(before) && grid.contain(after));
    EXPECT_TRUE(before <= t && t - before < 10) << t;
    EXPECT_TRUE(after >= t && after - t < 10) << t;
  }
}

TEST(Boundaries, StandTheLimitsOfTime) {
  const Boundaries grid(Duration{std::numeric_limits<std::int64_t>::max()});
  const Wide least = wide(SimTime::min());
  EXPECT_TRUE(grid.at_or_before(least) <= least);
  EXPECT_TRUE(grid.at_or_after(wide(SimTime::max())) >= wide(SimTime::max()));
}

TEST(Ns, WritesDecimalDigits) {
  EXPECT_EQ(ns(0), "0 ns");
  EXPECT_EQ(ns(-15), "-15 ns");
  EXPECT_EQ(ns(wide(SimTime::max())), "9223372036854775807 ns");
  EXPECT_EQ(ns(wide(SimTime::min())), "-9223372036854775808 ns");
}

}  // namespace
}  // namespace tether::audit
