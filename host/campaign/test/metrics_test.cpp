#include "flight.h"

#include <cmath>
#include <numbers>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/base/units.h>
#include <tether/campaign/metrics.h>

namespace tether::campaign {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

record::GroundTruth truth_at(SimTime at, double x_m, double y_m, double yaw_rad) {
  record::GroundTruth truth;
  truth.uav = "uav1";
  truth.at = at;
  truth.p_WB_m[0] = x_m;
  truth.p_WB_m[1] = y_m;
  truth.q_WB[0] = std::cos(yaw_rad / 2);
  truth.q_WB[3] = std::sin(yaw_rad / 2);
  return truth;
}

record::Anchor anchor_at(double x_m, double y_m) {
  record::Anchor anchor;
  anchor.name = "box";
  anchor.p_WA_m[0] = x_m;
  anchor.p_WA_m[1] = y_m;
  anchor.p_WA_m[2] = 1.0;
  return anchor;
}

// The anchor lies east of the UAV, so that its bearing is minus the yaw.
record::Record record_of_bearings_deg(const std::vector<double>& bearings_deg) {
  record::Record record;
  record.header.policy = "conservative_barrier";
  record.header.anchors = {anchor_at(4.0, 0.0)};
  SimTime at{};
  for (const double bearing_deg : bearings_deg) {
    record.ground_truth.push_back({at, 0, truth_at(at, 0, 0, -rad_from_deg(bearing_deg))});
    at += milliseconds(10);
  }
  return record;
}

void add_finish(record::Record& record, Duration requested, Duration arrived) {
  record::Interaction finish;
  finish.uav = "uav1";
  finish.kind = "finish";
  finish.request_at = ExecTime(requested);
  finish.st_at_arrival = SimTime(arrived);
  record.interactions.push_back({SimTime(requested), 0, finish});
}

scenario::Metric metric_of(const std::string& kind) {
  return {kind, kind, "Label", "1", "uav1", "box", rad_from_deg(2.0), std::nullopt};
}

MetricValue compute_one(const record::Record& record, const std::string& kind) {
  const std::vector<scenario::Metric> metrics = {metric_of(kind)};
  return compute_metrics(metrics, record).front();
}

TEST(TrueBearing, IsPositiveToTheLeftOfTheHeading) {
  EXPECT_NEAR(true_bearing_rad(truth_at({}, 0, 0, 0), anchor_at(1, 1)), rad_from_deg(45), 1e-12);
  EXPECT_NEAR(true_bearing_rad(truth_at({}, 0, 0, rad_from_deg(90)), anchor_at(1, 1)),
              rad_from_deg(-45), 1e-12);
  EXPECT_NEAR(true_bearing_rad(truth_at({}, 5, 1, rad_from_deg(170)), anchor_at(1, 1)),
              rad_from_deg(10), 1e-12);
  EXPECT_NEAR(true_bearing_rad(truth_at({}, 5, 1, rad_from_deg(-170)), anchor_at(1, 1)),
              rad_from_deg(-10), 1e-12);
}

TEST(TrueBearing, HardlyDependsOnTilt) {
  record::GroundTruth truth = truth_at({}, 0, 0, 0);
  truth.q_WB[0] = std::cos(0.1);
  truth.q_WB[1] = std::sin(0.1);  // roll of 0.2 rad
  EXPECT_NEAR(true_bearing_rad(truth, anchor_at(1, 0)), 0.0, 1e-12);
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
    const double rate_hz = 0.3 + random.uniform();
    const double omega_rad_s = 2.0 * std::numbers::pi * rate_hz;
    std::vector<double> bearings_rad;
    int expected = 0;
    double extreme_rad = 0.0, previous_rad = 0.0;
    bool first_half = true;
    for (double t_s = 0.0; t_s < 20.0; t_s += 0.004 + 0.002 * random.uniform()) {
      const double value_rad =
          amplitude_rad * std::exp(-damping_per_s * t_s) * std::cos(omega_rad_s * t_s);
      if (value_rad * previous_rad < 0.0) {
        if (!first_half && extreme_rad > kThreshold_rad) ++expected;
        first_half = false;
        extreme_rad = 0.0;
      }
      extreme_rad = std::max(extreme_rad, std::abs(value_rad));
      previous_rad = value_rad;
      bearings_rad.push_back(value_rad);
    }
    if (!first_half && extreme_rad > kThreshold_rad) ++expected;
    EXPECT_EQ(count_overshoots(bearings_rad, kThreshold_rad), expected) << seed;
  }
}

TEST(TimeRequired, IsTheRequestsOwnTimestampUnderTheBarrier) {
  record::Record record = record_of_bearings_deg({0});
  add_finish(record, milliseconds(2480), milliseconds(2440));
  EXPECT_EQ(compute_one(record, "time_required").value, 2.48);
}

TEST(TimeRequired, IsTheSimulatedTimeOfTheMomentInFreeRunning) {
  record::Record record = record_of_bearings_deg({0});
  record.header.policy = "free_running";
  add_finish(record, milliseconds(9000), milliseconds(2504));
  EXPECT_EQ(compute_one(record, "time_required").value, 2.504);
}

TEST(TimeRequired, IsMissingWhereTheSutDidNotFinish) {
  record::Record record = record_of_bearings_deg({0});
  add_finish(record, milliseconds(1), milliseconds(1));
  record.interactions[0].message.uav = "uav2";
  const MetricValue value = compute_one(record, "time_required");
  EXPECT_FALSE(value.value);
  EXPECT_THAT(value.missing_because, HasSubstr("'uav1' did not finish"));
  EXPECT_FALSE(value.is_met());
}

TEST(Oscillations, AreCountedUntilTheSutFinished) {
  record::Record record = record_of_bearings_deg({30, 10, -10, 0, 0, 10});
  EXPECT_EQ(compute_one(record, "oscillations").value, 2.0);
  add_finish(record, milliseconds(40), milliseconds(40));
  EXPECT_EQ(compute_one(record, "oscillations").value, 1.0);
}

TEST(Oscillations, AreThoseOfTheMetricsUav) {
  record::Record record = record_of_bearings_deg({30, 10});
  for (auto& logged : record.ground_truth) logged.message.uav = "uav2";
  const MetricValue value = compute_one(record, "oscillations");
  EXPECT_FALSE(value.value);
  EXPECT_THAT(value.missing_because, HasSubstr("no ground truth of 'uav1'"));
}

TEST(FinalBearingError, IsItsMagnitudeWhenTheSutFinished) {
  record::Record record = record_of_bearings_deg({30, 10, -3, -8});
  EXPECT_FALSE(compute_one(record, "final_bearing_error").value);
  add_finish(record, milliseconds(25), milliseconds(25));
  EXPECT_NEAR(*compute_one(record, "final_bearing_error").value, 3.0, 1e-9);
}

TEST(AcquisitionTime, IsTheMeanOverTheSensorsReadsButTheFirst) {
  Flight flight;
  flight.image(0, 0, 900).image(100, 1, 30).image(200, 2, 60).image(300, 3, 0).finish(400);
  EXPECT_NEAR(*flight.metric("acquisition_time").value, 30.0, 1e-9);
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

TEST(AcquisitionTime, IsMissingWhereTheSensorWasNotReadTwice) {
  Flight flight;
  flight.image(0, 0).image(0, 1).image(0, 2).finish(300);
  flight.record().interactions[0].message.uav = "uav2";
  flight.record().interactions[1].message.sensor = "range";
  EXPECT_FALSE(flight.metric("acquisition_time").value);
  EXPECT_THAT(flight.metric("acquisition_time").missing_because,
              HasSubstr("the SUT of 'uav1' did not read 'camera' more than once"));
}

TEST(ComputeMetrics, SayWhatTheRecordLacks) {
  record::Record record = record_of_bearings_deg({0});
  record.header.anchors.clear();
  EXPECT_THAT(compute_one(record, "oscillations").missing_because, HasSubstr("no anchor 'box'"));
}

TEST(ComputeMetrics, NeverGiveANumberThatIsNone) {
  record::Record record = record_of_bearings_deg({30, std::nan("")});
  add_finish(record, milliseconds(50), milliseconds(50));
  EXPECT_FALSE(compute_one(record, "final_bearing_error").value);
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
  for (const scenario::MetricKind& kind : scenario::metric_kinds()) {
    const MetricValue value = flight.metric(std::string(kind.name));
    EXPECT_TRUE(value.value) << kind.name << ": " << value.missing_because;
  }
  EXPECT_THAT(flight.metric("nonsense").missing_because, HasSubstr("no metric of the kind"));
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
}

}  // namespace
}  // namespace tether::campaign
