#include "flight.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::campaign {
namespace {

using testing::HasSubstr;

// From (0, 0), heading east, the box at (4.6, 2) reaches from a slope of 1.5 / 5 (its far right
// edge) to one of 2.5 / 4 (its near left edge), as seen from the camera at (0.1, 0).
const double kTrueBearing_deg = deg_from_rad(0.5 * (std::atan(0.625) + std::atan(0.3)));
// And its centre is (4.5, 2) from there.
const double kTrueDistance_m = std::sqrt(4.5 * 4.5 + 2.0 * 2.0);

std::string estimate(double bearing_deg, const std::string& distance_m, std::uint64_t image = 7,
                     const std::string& anchor = "box", const std::string& camera = "camera") {
  return R"({"anchor":")" + anchor + R"(","camera":")" + camera + R"(","image_index":)" +
         std::to_string(image) + R"(,"bearing_rad":)" + std::to_string(rad_from_deg(bearing_deg)) +
         R"(,"distance_m":)" + distance_m + R"(,"converged":true})";
}

Flight standing() {
  Flight flight;
  flight.pose(0, 0.0, 0.0, 0.0).image(50, 7).pose(100, 0.0, 0.0, 0.0);
  return flight;
}

TEST(Estimates, AreComparedWithTheBearingAndTheHorizontalDistanceFromTheCamera) {
  for (const double off : {0.0, 0.4, -1.5}) {
    Flight flight = standing();
    flight.record().header.anchors[0].p_WA_m[2] = 0.6;
    flight.note("estimate", estimate(kTrueBearing_deg + off, std::to_string(4.5 + off)));
    flight.finish(100);
    EXPECT_NEAR(*flight.metric("bearing_error").value, std::abs(off), 1e-4);
    EXPECT_NEAR(*flight.metric("distance_error").value, std::abs(4.5 + off - kTrueDistance_m),
                1e-12);
  }
}

// The UAV turns by 20 degrees in 100 ms and goes on; the image is of 50 ms, when it had turned by
// 10 and moved to x = 0.5.
TEST(BearingError, IsThatOfTheImageNotOfNow) {
  Flight flight;
  flight.anchor_at(4.6, 0.0).pose(0, 0.0, 0.0, 0.0).image(50, 7).pose(100, 1.0, 0.0, 20.0);
  flight.pose(200, 3.0, 0.0, 60.0).note("estimate", estimate(-10.0, "4")).finish(200);
  // Seen from 0.1 m ahead of (0.5, 0) under 10 degrees; the bearing differs a little from −10.
  const double value_deg = *flight.metric("bearing_error").value;
  EXPECT_GT(value_deg, 0.0);
  EXPECT_LT(value_deg, 1.0);
  const double camera_x_m = 0.5 + 0.1 * std::cos(rad_from_deg(10.0));
  const double camera_y_m = 0.1 * std::sin(rad_from_deg(10.0));
  EXPECT_NEAR(*flight.metric("distance_error").value,
              std::abs(4.0 - std::hypot(4.6 - camera_x_m, camera_y_m)), 1e-9);
}

TEST(Estimates, CountIfTheyAreTheLastValidOfTheMetricsUavAndAnchorBeforeTheFinish) {
  Flight flight = standing();
  flight.note("estimate", estimate(kTrueBearing_deg + 9.0, "1"));
  flight.note("estimate", estimate(kTrueBearing_deg + 2.0, "5"));
  flight.note("roi", estimate(kTrueBearing_deg + 7.0, "3"));
  flight.note("estimate", estimate(kTrueBearing_deg + 5.0, "5", 7, "red_box"));
  flight.note("estimate", estimate(kTrueBearing_deg + 7.0, "5"));
  flight.record().annotations.back().message.uav = "uav2";
  for (const char* invalid :
       {"", "{", "[]", "null", "\"text\"", "{}", R"({"text":"hello"})",
        R"({"anchor":"box","camera":"camera","image_index":7})",
        R"({"anchor":"box","camera":"camera","image_index":-1,"bearing_rad":0})",
        R"({"anchor":"box","camera":"camera","image_index":7.5,"bearing_rad":0})",
        R"({"anchor":"box","camera":"camera","image_index":7,"bearing_rad":null})",
        R"({"anchor":"box","camera":"camera","image_index":7,"bearing_rad":1e999})",
        R"({"anchor":"box","camera":3,"image_index":7,"bearing_rad":0})",
        R"({"camera":"camera","image_index":7,"bearing_rad":0})"})
    flight.note("estimate", invalid);
  flight.finish(100).note("estimate", estimate(kTrueBearing_deg, "2"));
  EXPECT_NEAR(*flight.metric("bearing_error").value, 2.0, 1e-4);
  EXPECT_NEAR(*flight.metric("distance_error").value, 5.0 - kTrueDistance_m, 1e-12);
}

// As a camera's images under free running and of an on-demand one: no grid, no state's instant.
TEST(Estimates, AnImageWithoutItsStatesInstantIsOfItsSampling) {
  Flight flight = standing();
  flight.record().interactions[0].message.sample_state_at.reset();
  flight.note("estimate", estimate(kTrueBearing_deg + 2.0, "5")).finish(100);
  EXPECT_NEAR(*flight.metric("bearing_error").value, 2.0, 1e-4);
}

TEST(Estimates, NameWhatIsMissing) {
  struct Lack {
    const char* what;
    void (*take_away)(Flight&);
  };
  const Lack lacks[] = {
      {"'box'", [](Flight& f) { f.record().header.anchors.clear(); }},
      {"'camera'", [](Flight& f) { f.record().header.sensors[0].camera.reset(); }},
      {"'camera'", [](Flight& f) { f.record().header.sensors[0].uav = "uav2"; }},
      {"image 7", [](Flight& f) { f.record().interactions[0].message.sample_index = 8; }},
      {"ground truth", [](Flight& f) { f.record().ground_truth.clear(); }},
      {"'box'", [](Flight& f) { f.record().annotations.clear(); }},
      {"finish", [](Flight& f) { f.record().interactions.pop_back(); }},
  };
  for (const char* kind : {"bearing_error", "distance_error"}) {
    for (const Lack& lack : lacks) {
      Flight flight = standing();
      flight.note("estimate", estimate(0.0, "5")).finish(100);
      ASSERT_TRUE(flight.metric(kind).value);
      lack.take_away(flight);
      EXPECT_FALSE(flight.metric(kind).value) << lack.what;
      EXPECT_THAT(flight.metric(kind).missing_because, HasSubstr(lack.what));
    }
  }
}

TEST(BearingError, NeedsAnAnchorInFrontOfTheCamera) {
  Flight flight = standing();
  flight.anchor_at(-4.0, 0.0).note("estimate", estimate(0.0, "5")).finish(100);
  EXPECT_THAT(flight.metric("bearing_error").missing_because, HasSubstr("'camera'"));
  EXPECT_TRUE(flight.metric("distance_error").value);
}

// The left half of the box is hidden: its bearing is that of the visible half.
TEST(BearingError, IsThatOfTheVisiblePixels) {
  Flight flight = standing();
  flight.anchor_at(4.6, 0.0).note("estimate", estimate(0.0, "5")).finish(100);
  EXPECT_NEAR(*flight.metric("bearing_error").value, 0.0, 1e-9);
  auto& seen = flight.record().interactions[0].message.seen_anchors;
  seen.emplace().push_back({"box", 320, 200, 359, 280, 3240});
  // From 319.5 to the true edge of the box, 320 · 0.5 / 4 = 40 px to the right.
  const double half_deg = deg_from_rad(std::atan2(40.0, 320.0)) / 2.0;
  EXPECT_NEAR(*flight.metric("bearing_error").value, half_deg, 1e-4);
  seen->clear();
  EXPECT_THAT(flight.metric("bearing_error").missing_because, HasSubstr("hidden"));
  EXPECT_TRUE(flight.metric("distance_error").value);
}

TEST(DistanceError, NeedsADistanceInTheLastEstimate) {
  Flight flight = standing();
  flight.note("estimate", estimate(0.0, "4.9")).note("estimate", estimate(0.0, "null"));
  flight.finish(100);
  EXPECT_THAT(flight.metric("distance_error").missing_because, HasSubstr("distance"));
  EXPECT_TRUE(flight.metric("bearing_error").value);
}

// ---- estimate_error

// Heading north, (−0.3, 0.2) in W is 0.2 ahead and 0.3 to the left.
TEST(EstimateError, ComparesTheLastValidDisplacementInTheStartHeadingFrame) {
  Flight flight;
  flight.pose(0, 5.0, 5.0, 90.0).pose(1'000, 4.7, 5.2, 95.0);
  flight.note("displacement", R"({"x_m":9,"y_m":0})");
  flight.note("displacement", R"({"x_m":0.5,"y_m":-0.1})");
  flight.note("displacement", R"({"x_m":3})").note("displacement", R"({"x_m":3,"y_m":"0"})");
  flight.finish(1'000).note("displacement", R"({"x_m":1,"y_m":0})");
  EXPECT_NEAR(*flight.metric("estimate_error").value, 0.5, 1e-12);  // (0.3, −0.4)
}

TEST(EstimateError, NamesWhatIsMissing) {
  Flight flight;
  flight.pose(0, 0.0, 0.0, 0.0).pose(1'000, 1.0, 0.0, 0.0);
  EXPECT_THAT(flight.metric("estimate_error").missing_because, HasSubstr("finish"));
  flight.finish(1'000);
  EXPECT_THAT(flight.metric("estimate_error").missing_because, HasSubstr("displacement"));
  Flight blind;
  blind.note("displacement", R"({"x_m":1,"y_m":0})").finish(1'000);
  EXPECT_THAT(blind.metric("estimate_error").missing_because, HasSubstr("ground truth"));
}

}  // namespace
}  // namespace tether::campaign
