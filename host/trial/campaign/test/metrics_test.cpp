#include "flight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/base/units.h>
#include <tether/campaign/metrics.h>

namespace tether::campaign {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

// The anchor lies east of the UAV, so that its bearing is minus the yaw.
Flight with_bearings_deg(const std::vector<double>& bearings_deg) {
  Flight flight;
  flight.anchor_at(4.0, 0.0);
  std::int64_t ms = 0;
  for (const double bearing_deg : bearings_deg) flight.pose(10 * ms++, 0.0, 0.0, -bearing_deg);
  return flight;
}

TEST(TrueBearing, IsPositiveToTheLeftOfTheHeading) {
  const auto bearing_deg = [](Flight& flight) {
    return deg_from_rad(true_bearing_rad(flight.record().ground_truth[0].message,
                                         flight.record().header.anchors[0]));
  };
  const auto seen_from = [&](double x_m, double y_m, double yaw_deg) {
    Flight flight;
    return bearing_deg(flight.anchor_at(1.0, 1.0).pose(0, x_m, y_m, yaw_deg));
  };
  EXPECT_NEAR(seen_from(0, 0, 0), 45, 1e-9);
  EXPECT_NEAR(seen_from(0, 0, 90), -45, 1e-9);
  EXPECT_NEAR(seen_from(5, 1, 170), 10, 1e-9);
  EXPECT_NEAR(seen_from(5, 1, -170), -10, 1e-9);
  Flight rolled = with_bearings_deg({0});
  rolled.record().ground_truth[0].message.q_WB[0] = std::cos(0.1);
  rolled.record().ground_truth[0].message.q_WB[1] = std::sin(0.1);
  EXPECT_NEAR(bearing_deg(rolled), 0, 1e-9);
}

struct Course {
  const char* name;
  std::vector<double> bearings_deg;
  int overshoots;  // with a threshold of 2 degrees
};

TEST(CountOvershoots, OfSyntheticCourses) {
  const std::vector<Course> courses = {
      {"nothing", {}, 0},
      {"stands", {30, 30}, 0},
      {"stops before", {30, 10, 1}, 0},
      {"stops just past", {30, 10, 1, -1.9}, 0},
      {"the threshold itself does not count", {30, -2}, 0},
      {"past and stays", {30, 10, -2.1, -2.2}, 1},
      {"past from the right", {-30, -10, 2.1}, 1},
      {"there and back", {30, -10, 1, -1, 10}, 2},
      {"there, back to the middle", {30, -10, 0, 1.5, -1.5, 0}, 1},
      {"back to the same side is no overshoot", {30, 1, -1, 5, 1}, 0},
      {"swings die out", {34, 0, -20, 0, 10, 0, -5, 0, 2.5, 0, -1.2, 0}, 4},
      {"starts inside the threshold", {1, -1, -10}, 0},
      {"turns the long way round", {30, 120, 179, -170, -60, -1, 0}, 0},
      {"past, then all the way round", {30, -10, -100, -179, 170, 60, 1}, 1},
      {"a whole turn past it twice", {30, -10, -100, -179, 170, 60, 10, -10}, 2},
  };
  for (const Course& course : courses) {
    SCOPED_TRACE(course.name);
    std::vector<double> bearings_rad, mirrored_rad;
    for (const double deg : course.bearings_deg) {
      bearings_rad.push_back(rad_from_deg(deg));
      mirrored_rad.push_back(rad_from_deg(-deg));
    }
    EXPECT_EQ(count_overshoots(bearings_rad, rad_from_deg(2.0)), course.overshoots);
    EXPECT_EQ(count_overshoots(mirrored_rad, rad_from_deg(2.0)), course.overshoots);
  }
}

// A damped swing passes zero once per half period; its overshoots are the extremes beyond the
// threshold, whatever the sampling.
TEST(CountOvershoots, OfADampedSwingAreItsExtremesBeyondTheThreshold) {
  constexpr double kThreshold_rad = 0.03;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    KeyedRandom random({seed, 1, 0});
    const double amplitude_rad = 0.2 + random.uniform();
    const double damping_per_s = 0.2 + 2.0 * random.uniform();
    const double omega_rad_s = 2.0 * std::numbers::pi * (0.3 + random.uniform());
    std::vector<double> bearings_rad;
    std::vector<double> extremes_rad = {0.0};  // of each half period
    for (double t_s = 0.0; t_s < 20.0; t_s += 0.004 + 0.002 * random.uniform()) {
      const double value_rad =
          amplitude_rad * std::exp(-damping_per_s * t_s) * std::cos(omega_rad_s * t_s);
      if (!bearings_rad.empty() && value_rad * bearings_rad.back() < 0.0)
        extremes_rad.push_back(0.0);
      extremes_rad.back() = std::max(extremes_rad.back(), std::abs(value_rad));
      bearings_rad.push_back(value_rad);
    }
    const auto expected =
        std::count_if(extremes_rad.begin() + 1, extremes_rad.end(),
                      [](double extreme_rad) { return extreme_rad > kThreshold_rad; });
    EXPECT_EQ(count_overshoots(bearings_rad, kThreshold_rad), expected) << seed;
  }
}

TEST(TimeRequired, IsTheRequestsTimestampUnderTheBarrierAndElseTheStOfItsArrival) {
  Flight flight;
  EXPECT_FALSE(flight.metric("time_required").value);
  flight.finish(2504);
  record::Interaction& finish = flight.record().interactions[0].message;
  finish.request_at = ExecTime(milliseconds(9000));
  EXPECT_EQ(flight.metric("time_required").value, 9.0);
  flight.record().header.policy = record::kFreeRunning;
  EXPECT_EQ(flight.metric("time_required").value, 2.504);
  finish.uav = "uav2";
  EXPECT_FALSE(flight.metric("time_required").value);
}

TEST(Oscillations, AreCountedUntilTheSutFinished) {
  Flight flight = with_bearings_deg({30, 10, -10, 0, 0, 10});
  EXPECT_EQ(flight.metric("oscillations").value, 2.0);
  EXPECT_EQ(flight.finish(40).metric("oscillations").value, 1.0);
}

TEST(Oscillations, NeedTheMetricsUavAndAnchor) {
  Flight flight = with_bearings_deg({30, 10});
  for (auto& logged : flight.record().ground_truth) logged.message.uav = "uav2";
  EXPECT_THAT(flight.metric("oscillations").missing_because, HasSubstr("'uav1'"));
  flight.record().header.anchors.clear();
  EXPECT_THAT(flight.metric("oscillations").missing_because, HasSubstr("'box'"));
}

TEST(FinalBearingError, IsItsFiniteMagnitudeWhenTheSutFinished) {
  Flight flight = with_bearings_deg({30, 10, -3, std::nan("")});
  EXPECT_FALSE(flight.metric("final_bearing_error").value);
  EXPECT_NEAR(*flight.finish(25).metric("final_bearing_error").value, 3.0, 1e-9);
  flight.record().interactions.clear();
  EXPECT_FALSE(flight.finish(30).metric("final_bearing_error").value) << "not a number";
}

TEST(AcquisitionTime, IsTheMeanOverTheSensorsReadsButTheFirst) {
  Flight flight;
  flight.image(0, 0, 900);
  EXPECT_THAT(flight.metric("acquisition_time").missing_because, HasSubstr("'camera'"));
  flight.image(100, 1, 30).image(200, 2, 60).image(300, 3, 0).image(310, 4).image(320, 5);
  flight.record().interactions[4].message.uav = "uav2";
  flight.record().interactions[5].message.sensor = "range";
  EXPECT_NEAR(*flight.finish(400).metric("acquisition_time").value, 30.0, 1e-9);
}

// Where ST runs with the wall clock, at its own pace, also while an image is drawn and sent.
TEST(AcquisitionTime, CountsDrawingAndTheLinkInFreeRunningOnly) {
  Flight flight;
  flight.image(0, 0, 30).image(100, 1, 30).image(200, 2, 30).finish(300);
  auto& reads = flight.record().interactions;
  for (auto& read : reads)
    read.message.wall_at_release = read.message.wall_at_arrival + milliseconds(12);
  reads[2].message.previous_link_time = milliseconds(40);
  reads[3].message.previous_link_time = milliseconds(20);
  EXPECT_NEAR(*flight.metric("acquisition_time").value, 30.0, 1e-9);
  flight.record().header.policy = record::kFreeRunning;
  flight.record().header.real_time_factor = 0.5;
  flight.record().footer.reset();
  EXPECT_NEAR(*flight.metric("acquisition_time").value, 0.5 * (12.0 + 30.0), 1e-9);
  flight.record().footer = record::Footer{};
  flight.record().footer->st_at_end = SimTime(milliseconds(100));
  flight.record().footer->wall = milliseconds(400);
  EXPECT_NEAR(*flight.metric("acquisition_time").value, 0.25 * (12.0 + 30.0), 1e-9)
      << "of a simulator that was slower than its limit";
}

// The registry here and the list that scenarios are checked against are the same.
TEST(ComputeMetrics, KnowEveryKindThatAScenarioMayAskFor) {
  Flight flight;
  flight.pose(0, 0.0, 0.0, 0.0)
      .image(0, 6)
      .image(0, 7)
      .note("displacement", R"({"x_m":1,"y_m":2})");
  flight.note(
      "estimate",
      R"({"anchor":"box","camera":"camera","image_index":7,"bearing_rad":0,"distance_m":1})");
  flight.finish(50);
  flight.record().header.reports_contacts = true;
  record::Battery battery;
  battery.uav = "uav1";
  flight.record().batteries.push_back({SimTime{}, 0, battery});
  flight.record().footer.emplace().clearances = {{"uav1", 0.5, {}, "box"}};
  record::RadioMessage message;
  message.outcome = record::kDelivered;
  for (const auto& [from, to] : {std::pair("uav1", "uav2"), std::pair("uav2", "uav1")}) {
    message.uav = from;
    message.to = to;
    flight.record().radio.push_back({SimTime{}, 0, message});
  }
  for (const scenario::MetricKind& kind : scenario::metric_kinds()) {
    const MetricValue value = flight.metric(std::string(kind.name));
    EXPECT_TRUE(value.value) << kind.name << ": " << value.missing_because;
  }
  EXPECT_THAT(flight.metric("nonsense").missing_because, HasSubstr("'nonsense'"));
}

TEST(MetricValue, IsMetUpToItsLimit) {
  MetricValue value;
  EXPECT_FALSE(value.is_met());
  value.value = 2.0;
  EXPECT_TRUE(value.is_met());
  value.max = 2.0;
  EXPECT_TRUE(value.is_met());
  value.max = 1.9;
  EXPECT_FALSE(value.is_met());
  value.max.reset();
  value.min = 2.0;
  EXPECT_TRUE(value.is_met());
  value.min = 2.1;
  EXPECT_FALSE(value.is_met());
}

}  // namespace
}  // namespace tether::campaign
