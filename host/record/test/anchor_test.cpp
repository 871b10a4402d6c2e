#include <chrono>
#include <numbers>

#include <gtest/gtest.h>

#include <tether/record/messages.h>

namespace tether::record {
namespace {

constexpr SimTime kAt = SimTime{std::chrono::seconds(2)};

TEST(AnchorAt, OneWithoutAPathIsWhereItWasPlaced) {
  const Anchor anchor{.name = "box", .shape = "box", .p_WA_m = {1, 2, 3}};
  EXPECT_EQ(anchor_at(anchor, kAt).p_WA_m[2], 3.0);
}

// Its model turns by a quarter, and the anchor is 1 m ahead in it.
TEST(AnchorAt, FollowsItsModelAboutTheModelsOrigin) {
  const Anchor anchor{.name = "box",
                      .shape = "box",
                      .p_WA_m = {1, 0, 0.5},
                      .path = {{Duration{0}, {0, 0, 0}, 0.0},
                               {std::chrono::seconds(1), {5, 0, 0}, 0.5 * std::numbers::pi}},
                      .p_WO_m = {0, 0, 0.5}};
  const Anchor moved = anchor_at(anchor, kAt);
  EXPECT_NEAR(moved.p_WA_m[0], 5.0, 1e-12);
  EXPECT_NEAR(moved.p_WA_m[1], 1.0, 1e-12);
  EXPECT_NEAR(moved.p_WA_m[2], 0.5, 1e-12);
  EXPECT_NEAR(moved.q_WA[3], std::numbers::sqrt2 / 2.0, 1e-12);
  EXPECT_TRUE(moved.path.empty());
}

}  // namespace
}  // namespace tether::record
