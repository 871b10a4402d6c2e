#include "sensors/range.h"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace tether::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

RangeModel range_model(double min_m, double max_m, double resolution_m) {
  return {min_m, max_m, resolution_m, {}};
}

// What a rangefinder reads of something at one distance.
double reading(const RangeModel& model, double distance_m, const MeasurementKey& key = {}) {
  return measure_range(model, {&distance_m, 1}, key).range_m;
}

TEST(RangeTest, ReadsTheNearestOfAllRays) {
  const RangeModel model = range_model(0.2, 4.0, 0.0);
  EXPECT_EQ(measure_range(model, std::array{kInfinity, 2.0, 1.5, 3.0}, {}).range_m, 1.5);
  EXPECT_EQ(measure_range(model, std::array{kInfinity, kInfinity}, {}).range_m, kInfinity);
}

TEST(RangeTest, LimitsAndResolution) {
  const RangeModel model = range_model(0.2, 4.0, 0.25);
  EXPECT_EQ(reading(model, 1.1), 1.0);
  EXPECT_EQ(reading(model, 3.9), 4.0);
  EXPECT_EQ(reading(model, 4.2), kInfinity);
  EXPECT_EQ(reading(model, 0.1), -kInfinity);
  EXPECT_EQ(reading(model, kInfinity), kInfinity);
  EXPECT_EQ(reading(range_model(0.2, 4.0, 0.0), 1.1), 1.1);
}

TEST(RangeTest, WhatIsFartherThanTheFarthestIsNeverRead) {
  RangeModel model = range_model(0.2, 4.0, 0.5);
  EXPECT_EQ(farthest_read_m(model), 4.25);
  model.noise = {-0.3, 0.2, -0.1, 0.15, 0.4, 0.5};
  const double farthest_m = farthest_read_m(model);
  int read_near = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const MeasurementKey key{seed, "alpha", "range", seed, SimTime(std::chrono::seconds(7))};
    EXPECT_EQ(reading(model, farthest_m, key), kInfinity);
    if (reading(model, 4.4, key) < kInfinity) ++read_near;
  }
  EXPECT_GT(read_near, 1000) << "beyond the limit, read as nearer";
}

TEST(RangeTest, DropoutsHaveTheirShareAndAreKeyed) {
  RangeModel model = range_model(0.2, 4.0, 0.0);
  model.dropout_probability = 0.2;
  const auto dropped = [&](std::uint64_t seed, std::string_view sensor, std::uint64_t index) {
    const double range_m = reading(model, 1.5, {seed, "alpha", sensor, index, {}});
    EXPECT_TRUE(range_m == 1.5 || range_m == kInfinity);
    return range_m == kInfinity;
  };
  constexpr int kCount = 20'000;
  int drops = 0;
  int same_by_seed = 0;
  int same_by_sensor = 0;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const bool drop = dropped(1, "range", i);
    EXPECT_EQ(drop, dropped(1, "range", i));
    drops += drop ? 1 : 0;
    same_by_seed += drop == dropped(2, "range", i) ? 1 : 0;
    same_by_sensor += drop == dropped(1, "other", i) ? 1 : 0;
  }
  EXPECT_NEAR(drops, 0.2 * kCount, 5.0 * std::sqrt(0.16 * kCount));
  const double independent = (0.2 * 0.2 + 0.8 * 0.8) * kCount;
  EXPECT_NEAR(same_by_seed, independent, 5.0 * std::sqrt(0.22 * kCount));
  EXPECT_NEAR(same_by_sensor, independent, 5.0 * std::sqrt(0.22 * kCount));
}

TEST(RangeTest, DropoutsReadInfinityHoweverCloseAndLeaveOtherReadingsUnchanged) {
  RangeModel model = range_model(0.2, 4.0, 0.0);
  model.noise.stddev = 0.1;
  RangeModel dropping = model;
  dropping.dropout_probability = 0.5;
  int dropped = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const MeasurementKey key{3, "alpha", "range", i, {}};
    const double distance_m = i % 2 == 0 ? 0.0 : 2.0;
    const double range_m = reading(dropping, distance_m, key);
    if (range_m == kInfinity) {
      ++dropped;
    } else {
      EXPECT_EQ(range_m, reading(model, distance_m, key));
    }
  }
  EXPECT_NEAR(dropped, 100, 30);
}

// However wild the noise, a reading is within the limits, or infinite.
TEST(RangeTest, NeverAnythingButARangeOrInfinity) {
  RangeModel model = range_model(0.2, 4.0, 0.01);
  model.noise.stddev = 3.0;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const double range_m = reading(model, 1.0, {1, "alpha", "range", i, {}});
    EXPECT_TRUE((range_m >= 0.2 && range_m <= 4.0) || std::isinf(range_m)) << range_m;
  }
}

}  // namespace
}  // namespace tether::sim
