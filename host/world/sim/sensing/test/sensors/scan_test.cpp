#include "sensors/scan.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using uav::Vec3;

constexpr double kNothing_m = std::numeric_limits<double>::infinity();

ScanModel scan_of(int columns, int rows) {
  return {{.columns = columns, .rows = rows, .min_m = 0.2, .max_m = 4.0}, 0.0, {}};
}

std::vector<float> ranges_of(const ScanModel& scan, const std::vector<double>& distances_m,
                             const MeasurementKey& key = {}) {
  return measure_scan(scan, distances_m, key).ranges_m;
}

TEST(Scan, RaysAreSpacedEvenlyAlongAzimuthAndElevation) {
  ScanModel scan = scan_of(3, 2);
  scan.rays.min_azimuth_rad = -0.5 * std::numbers::pi;
  scan.rays.max_azimuth_rad = 0.5 * std::numbers::pi;
  scan.rays.max_elevation_rad = 0.25 * std::numbers::pi;
  const auto rays = rays_of(scan);
  ASSERT_EQ(rays.size(), 6U);
  const double half = std::sqrt(0.5);
  EXPECT_LT(norm(rays[0] - Vec3{0.0, -1.0, 0.0}), 1e-12);
  EXPECT_LT(norm(rays[1] - Vec3{0.0, -half, half}), 1e-12) << "column by column";
  EXPECT_LT(norm(rays[2] - Vec3{1.0, 0.0, 0.0}), 1e-12);
  EXPECT_LT(norm(rays[5] - Vec3{0.0, half, half}), 1e-12);
  scan = scan_of(1, 1);
  scan.rays.max_azimuth_rad = std::numbers::pi;
  EXPECT_LT(norm(rays_of(scan)[0] - Vec3{0.0, 1.0, 0.0}), 1e-12) << "a single ray: the middle";
}

TEST(Scan, RangesAreRowByRow) {
  EXPECT_THAT(ranges_of(scan_of(3, 2), {1.0, 1.5, 2.0, 2.5, 3.0, 3.5}),
              ElementsAre(1.0F, 2.0F, 3.0F, 1.5F, 2.5F, 3.5F));
}

TEST(Scan, LimitsAndResolution) {
  ScanModel scan = scan_of(5, 1);
  scan.resolution_m = 0.25;
  const auto inf = static_cast<float>(kNothing_m);
  EXPECT_THAT(ranges_of(scan, {1.1, 3.9, 4.2, 0.1, kNothing_m}),
              ElementsAre(1.0F, 4.0F, inf, -inf, inf));
}

TEST(Scan, ASweepEndsAtTheScansTime) {
  ScanModel scan = scan_of(101, 1);
  EXPECT_EQ(steps_ago(scan, 0, std::chrono::milliseconds(1)), 0U) << "all at once";
  scan.rays.sweep_s = 0.1;
  EXPECT_EQ(steps_ago(scan, 0, std::chrono::milliseconds(1)), 100U);
  EXPECT_EQ(steps_ago(scan, 50, std::chrono::milliseconds(1)), 50U);
  EXPECT_EQ(steps_ago(scan, 100, std::chrono::milliseconds(1)), 0U);
  EXPECT_EQ(steps_ago(scan, 0, std::chrono::milliseconds(4)), 25U);
}

TEST(Scan, NoiseIsWhitePerRayWithOneBias) {
  ScanModel scan = scan_of(20'000, 1);
  scan.noise = {0.1, 0.05, 0.0, 0.2, 0.0, 0.0};
  const std::vector<double> distances_m(20'000, 2.0);
  double bias_sum = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto ranges_m = ranges_of(scan, distances_m, {seed, "alpha", "scan", 1, {}});
    double sum = 0.0, squares = 0.0;
    for (const float range_m : ranges_m) {
      sum += range_m;
      squares += static_cast<double>(range_m) * range_m;
    }
    const double mean_m = sum / 20'000.0;
    EXPECT_NEAR(std::sqrt(squares / 20'000.0 - mean_m * mean_m), 0.05, 0.002);
    bias_sum += mean_m - 2.1;
  }
  EXPECT_NEAR(bias_sum / 20.0, 0.0, 4.0 * 0.2 / std::sqrt(20.0));
}

TEST(Scan, RaysDropOutWithTheirProbability) {
  ScanModel scan = scan_of(20'000, 1);
  scan.dropout_probability = 0.2;
  const auto ranges_m =
      ranges_of(scan, std::vector<double>(20'000, 0.05), {1, "alpha", "scan", 1, {}});
  const auto dropped = std::ranges::count(ranges_m, std::numeric_limits<float>::infinity());
  EXPECT_NEAR(static_cast<double>(dropped), 4000.0, 5.0 * std::sqrt(0.16 * 20'000.0));
  scan.dropout_probability = 1.0;
  EXPECT_THAT(ranges_of(scan, std::vector<double>(20'000, 1.0)),
              Each(std::numeric_limits<float>::infinity()));
}

// Two columns of two rows.
TEST(Scan, HasTheIntensityOfEachRangeAndNoneWhereThereIsNone) {
  const std::vector<float> intensities{0.25F, 0.5F, 0.75F, 1.0F};
  const auto scan = measure_scan(scan_of(2, 2), std::vector{1.0, 1.5, 5.0, 0.1}, {}, intensities);
  EXPECT_THAT(scan.intensities, ElementsAre(0.25F, 0.0F, 0.5F, 0.0F));
  EXPECT_THAT(measure_scan(scan_of(2, 2), std::vector(4, 1.0), {}).intensities, IsEmpty());
}

}  // namespace
}  // namespace tether::sim
