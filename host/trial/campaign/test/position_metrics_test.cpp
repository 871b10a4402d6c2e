#include "flight.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::campaign {
namespace {

using testing::HasSubstr;

TEST(AbeamError, IsTheHorizontalDistanceToTheFootOfThePerpendicularOnTheStartLine) {
  struct Case {
    double anchor_m[2], start_m[2], yaw_deg, end_m[2], expected_m;
  };
  const Case cases[] = {
      // East along y = 1: a box at (8, 3) is abeam at (8, 1).
      {{8.0, 3.0}, {0.0, 1.0}, 0.0, {7.7, 0.6}, 0.5},
      // North along x = 2: a box at (−1, 5) is abeam at (2, 5).
      {{-1.0, 5.0}, {2.0, 0.0}, 90.0, {2.0, 5.25}, 0.25},
      // From (0, 0) at 30 degrees: the foot of (4, 0) is 4·cos 30° along it, at (3, 1.7321).
      {{4.0, 0.0}, {0.0, 0.0}, 30.0, {3.0, 0.0}, std::sqrt(3.0)},
  };
  for (const Case& c : cases) {
    Flight flight;
    flight.anchor_at(c.anchor_m[0], c.anchor_m[1]).pose(0, c.start_m[0], c.start_m[1], c.yaw_deg);
    flight.pose(1'000, c.end_m[0], c.end_m[1], 80.0).finish(1'000);
    EXPECT_NEAR(*flight.metric("abeam_error").value, c.expected_m, 1e-12);
    flight.record().ground_truth.back().message.p_WB_m[2] = 9.0;
    flight.record().header.anchors[0].p_WA_m[2] = -4.0;
    EXPECT_NEAR(*flight.metric("abeam_error").value, c.expected_m, 1e-12)
        << "height does not count";
  }
}

// Under the barrier the request to finish is at 950 ms, half-way between two ground truths. In free
// running, the SUT's own clock does not determine where the UAV was.
TEST(ReturnError, IsTheDistanceFromTheStartWhenTheSutFinished) {
  Flight flight;
  flight.pose(0, 0.0, 1.0, 45.0).pose(900, 1.0, 1.0, 0.0).pose(1'000, 2.0, 1.0, 0.0).finish(950);
  flight.pose(1'100, 50.0, 0.0, 0.0);
  EXPECT_NEAR(*flight.metric("return_error").value, 1.5, 1e-12);
  flight.record().header.policy = record::kFreeRunning;
  flight.record().interactions.back().message.request_at = ExecTime(std::chrono::seconds(77));
  EXPECT_NEAR(*flight.metric("return_error").value, 1.5, 1e-12);
}

TEST(PositionErrors, NeedAFinishAndGroundTruthAtBothEnds) {
  struct Case {
    const char* missing;
    Flight flight;
  };
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const Case cases[] = {
      {"finish", Flight().pose(0, 0.0, 0.0, 0.0).pose(1'000, 2.0, 0.0, 0.0)},
      {"ground truth of 'uav1'", Flight().finish(1'000)},
      {"ground truth of 'uav1'", Flight().pose(0, 0.0, 0.0, 0.0).finish(101)},
      {"ground truth of 'uav1'", Flight().pose(101, 0.0, 0.0, 0.0).finish(101)},
      {"finite", Flight().pose(0, kInfinite, 0.0, 0.0).finish(0)},
  };
  for (const char* kind : {"abeam_error", "return_error"}) {
    for (const Case& c : cases) {
      EXPECT_FALSE(c.flight.metric(kind).value);
      EXPECT_THAT(c.flight.metric(kind).missing_because, HasSubstr(c.missing));
    }
  }
  Flight flight = Flight().pose(0, 0.0, 0.0, 0.0).finish(0);
  flight.record().header.anchors.clear();
  EXPECT_THAT(flight.metric("abeam_error").missing_because, HasSubstr("'box'"));
}

}  // namespace
}  // namespace tether::campaign
