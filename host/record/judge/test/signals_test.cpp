#include "signals.h"

#include <gtest/gtest.h>

namespace tether::judge {
namespace {

// An L, with its legs along x and y.
TEST(Signals, InsideIsTheDistanceToTheNearestEdgeOfTheFence) {
  record::GroundTruth truth;
  const auto inside = [&](double x_m, double y_m) {
    mission::Condition condition;
    condition.quantity = mission::find_quantity("inside");
    condition.fence = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}};
    const record::Record none;
    truth.p_WB_m[0] = x_m;
    truth.p_WB_m[1] = y_m;
    const auto fence = Reference::of(condition, truth, none);
    return value_of(*condition.quantity, truth, *fence);
  };
  EXPECT_DOUBLE_EQ(*inside(0.5, 2), 0.5);
  EXPECT_DOUBLE_EQ(*inside(3, 0.25), 0.25);
  EXPECT_DOUBLE_EQ(*inside(2, 2), -1.0) << "in the corner that is cut out";
  EXPECT_DOUBLE_EQ(*inside(7, 5), -5.0);
  EXPECT_DOUBLE_EQ(*inside(-1, 1), -1.0);
}

}  // namespace
}  // namespace tether::judge
