#include "cost_fit.h"

#include <cmath>

#include <gmock/gmock.h>

#include <tether/base/random.h>

namespace tether::calibration {
namespace {

using ::testing::SizeIs;

/// Blocks of random work, whose times are by these costs.
std::vector<CountedBlock> blocks_of(const Costs_ns& costs, std::size_t count, double noise = 0.0) {
  KeyedRandom random({.seed = 1, .stream = 2, .index = count});
  std::vector<CountedBlock> blocks(count);
  for (CountedBlock& block : blocks) {
    for (double& work : block.work) work = 1e3 * random.uniform();
    block.time_ns = predicted_ns(costs, block) * (1.0 + noise * random.normal());
    block.weight = 0.1 + random.uniform();
  }
  return blocks;
}

constexpr Costs_ns kCosts_ns = {0.3, 1.1, 7.0, 0.5, 0.4, 0.6, 1.3, 1.7, 0.2, 11.0};
constexpr Costs_ns kFloor_ns = {0.1, 0.1, 0.1, 0.1, 0.2, 0.2, 0.2, 0.2, 0.2, 2.0};

TEST(CostFit, FindsTheCostsOfExactTimes) {
  const auto blocks = blocks_of(kCosts_ns, 15);
  const Costs_ns fitted = fit_costs(blocks, kFloor_ns);
  for (std::size_t k = 0; k < kWorkClasses; ++k) EXPECT_NEAR(fitted[k], kCosts_ns[k], 1e-6) << k;
  for (const double error : errors_when_left_out(blocks, kFloor_ns)) EXPECT_NEAR(error, 0.0, 1e-6);
}

// Karush-Kuhn-Tucker: at the least sum no cost above its floor can improve it, and none at its
// floor by growing.
TEST(CostFit, IsTheLeastWithoutCostsBelowTheirFloor) {
  const auto blocks = blocks_of(kCosts_ns, 14, 0.3);
  const Costs_ns fitted = fit_costs(blocks, kFloor_ns);
  bool is_any_at_floor = false;
  for (std::size_t k = 0; k < kWorkClasses; ++k) {
    double slope = 0.0, scale = 0.0;
    for (const CountedBlock& block : blocks) {
      const double share = block.weight * block.work[k] / block.time_ns;
      slope += relative_error(fitted, block) * share;
      scale += share;
    }
    EXPECT_GE(fitted[k], kFloor_ns[k]);
    EXPECT_GE(slope, -1e-9 * scale) << k;
    if (fitted[k] > kFloor_ns[k]) {
      EXPECT_LE(slope, 1e-9 * scale) << k;
    }
    is_any_at_floor = is_any_at_floor || fitted[k] == kFloor_ns[k];
  }
  EXPECT_TRUE(is_any_at_floor);
}

TEST(CostFit, LeavesAKindAtItsFloorThatNoBlockHas) {
  auto blocks = blocks_of(kCosts_ns, 12);
  for (CountedBlock& block : blocks) {
    block.work[9] = 0.0;
    block.time_ns = predicted_ns(kCosts_ns, block);
  }
  EXPECT_EQ(fit_costs(blocks, kFloor_ns)[9], kFloor_ns[9]);
  EXPECT_THAT(errors_when_left_out(blocks, kFloor_ns), SizeIs(12));
}

TEST(CostFit, ErrorIsRelativeToTheTime) {
  CountedBlock block{.name = "a", .time_ns = 100.0, .work = {60.0, 60.0}};
  EXPECT_NEAR(relative_error({1.0, 1.0}, block), 0.2, 1e-12);
}

}  // namespace
}  // namespace tether::calibration
