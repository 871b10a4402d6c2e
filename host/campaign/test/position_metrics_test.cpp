#include "flight.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::campaign {
namespace {

using testing::HasSubstr;

// The start line goes east along y = 1; a box at (8, 3) is abeam at (8, 1).
TEST(AbeamError, IsTheDistanceToTheFootOfThePerpendicular) {
  Flight flight;
  flight.anchor_at(8.0, 3.0).pose(0, 0.0, 1.0, 0.0).pose(60'000, 7.7, 0.6, 80.0).finish(60'000);
  EXPECT_NEAR(*flight.metric("abeam_error").value, 0.5, 1e-12);  // (0.3, 0.4)
}

// Turned by 90 degrees: the line goes north along x = 2; a box at (−1, 5) is abeam at (2, 5).
TEST(AbeamError, FollowsTheStartHeading) {
  Flight flight;
  flight.anchor_at(-1.0, 5.0).pose(0, 2.0, 0.0, 90.0).pose(1'000, 2.0, 5.25, 0.0).finish(1'000);
  EXPECT_NEAR(*flight.metric("abeam_error").value, 0.25, 1e-12);
}

// From (0, 0) a heading of 30 degrees: the foot of (4, 0) is 4·cos 30° along it, at (3, 1.7321).
TEST(AbeamError, IsTakenFromTheTrueStartNotFromTheWorldsAxes) {
  Flight flight;
  flight.anchor_at(4.0, 0.0).pose(0, 0.0, 0.0, 30.0).pose(1'000, 3.0, 0.0, 30.0).finish(1'000);
  EXPECT_NEAR(*flight.metric("abeam_error").value, std::sqrt(3.0), 1e-12);
}

TEST(AbeamError, HeightDoesNotCount) {
  Flight flight;
  flight.anchor_at(8.0, 3.0).pose(0, 0.0, 0.0, 0.0).pose(1'000, 8.0, 0.0, 0.0).finish(1'000);
  flight.record().ground_truth.back().message.p_WB_m[2] = 9.0;
  flight.record().header.anchors[0].p_WA_m[2] = -4.0;
  EXPECT_NEAR(*flight.metric("abeam_error").value, 0.0, 1e-12);
}

TEST(ReturnError, IsTheDistanceFromTheStart) {
  Flight flight;
  flight.pose(0, 1.0, 2.0, 45.0).pose(500, 9.0, 9.0, 0.0).pose(1'000, 1.3, 1.6, 45.0).finish(1'000);
  EXPECT_NEAR(*flight.metric("return_error").value, 0.5, 1e-12);
}

// The request to finish came at 950 ms, half-way between two ground truths.
TEST(ReturnError, IsTakenWhenTheSutFinished) {
  Flight flight;
  flight.pose(0, 0.0, 0.0, 0.0).pose(900, 1.0, 0.0, 0.0).pose(1'000, 2.0, 0.0, 0.0).finish(950);
  flight.pose(1'100, 50.0, 0.0, 0.0);
  EXPECT_NEAR(*flight.metric("return_error").value, 1.5, 1e-12);
}

// Without the barrier the SUT's own clock says nothing of where the UAV was.
TEST(ReturnError, IsTakenAtTheMomentInFreeRunning) {
  Flight flight;
  flight.pose(0, 0.0, 0.0, 0.0).pose(900, 1.0, 0.0, 0.0).pose(1'000, 2.0, 0.0, 0.0).finish(900);
  flight.record().header.policy = record::kFreeRunning;
  flight.record().interactions.back().message.request_at = ExecTime(std::chrono::seconds(77));
  EXPECT_NEAR(*flight.metric("return_error").value, 1.0, 1e-12);
}

TEST(PositionErrors, SayWhatIsMissing) {
  for (const char* kind : {"abeam_error", "return_error"}) {
    SCOPED_TRACE(kind);
    Flight unfinished;
    unfinished.pose(0, 0.0, 0.0, 0.0).pose(1'000, 2.0, 0.0, 0.0);
    EXPECT_FALSE(unfinished.metric(kind).value);
    EXPECT_THAT(unfinished.metric(kind).missing_because, HasSubstr("did not finish"));

    Flight without_truth;
    without_truth.finish(1'000);
    EXPECT_THAT(without_truth.metric(kind).missing_because, HasSubstr("no ground truth of 'uav1'"));

    // Ground truth ends long before, or begins long after.
    Flight cut;
    cut.pose(0, 0.0, 0.0, 0.0).finish(101);
    EXPECT_FALSE(cut.metric(kind).value);
    Flight late;
    late.pose(101, 0.0, 0.0, 0.0).finish(101);
    EXPECT_FALSE(late.metric(kind).value);

    Flight infinite;
    infinite.pose(0, std::numeric_limits<double>::infinity(), 0.0, 0.0).finish(0);
    EXPECT_FALSE(infinite.metric(kind).value);
    EXPECT_THAT(infinite.metric(kind).missing_because, HasSubstr("not finite"));
  }
  Flight flight;
  flight.pose(0, 0.0, 0.0, 0.0).finish(0);
  flight.record().header.anchors.clear();
  EXPECT_THAT(flight.metric("abeam_error").missing_because, HasSubstr("no anchor 'box'"));
}

}  // namespace
}  // namespace tether::campaign
