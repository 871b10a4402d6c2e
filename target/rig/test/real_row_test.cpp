#include <cmath>

#include <gmock/gmock.h>

#include <tether/base/units.h>
#include <tether/rig/mission.h>
#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::rig {
namespace {

using tasks::testing::PlanarVehicle;
using ::testing::HasSubstr;

TaskSpec look_at(const std::string& anchor) {
  TaskSpec spec;
  // The fake's images are a quarter as wide as those that the default is for.
  spec.options = tasks::RelativePositionOptions{.convergence = {.tolerance_px = 2.0}};
  spec.anchor = anchor;
  return spec;
}

PlanarVehicle::Options box_ahead() {
  return {.anchor_bearing_rad = rad_from_deg(1.0), .anchor_distance_m = 9.0};
}

TEST(RealRow, ComparesWithTheRangefinder) {
  PlanarVehicle vehicle(box_ahead());
  const RealRow row = measure_real_row(look_at("blue_box"), std::nullopt, vehicle);
  ASSERT_TRUE(row.outcome.reached()) << row.outcome.reason;
  const auto& results = row.outcome.results;
  // The fake's rangefinder sees a wall at 10 m; the box is half a metre deep.
  EXPECT_NEAR(results.at("distance_reference_m"), 10.0 * std::cos(results.at("bearing_rad")) + 0.25,
              1e-9);
  EXPECT_NEAR(results.at("distance_error_m"),
              std::abs(results.at("distance_m") - results.at("distance_reference_m")), 1e-12);
  EXPECT_GT(results.at("distance_error_m"), 0.5);
  EXPECT_FALSE(results.contains("angle_error_deg"));
  EXPECT_TRUE(row.notes.empty());
  EXPECT_FALSE(vehicle.finished());
  EXPECT_NEAR(to_seconds(vehicle.now()) - results.at("duration_s"), 0.3, 1e-9)
      << "the reference does not count";
}

TEST(RealRow, ComparesWithAnAnnotatedImage) {
  PlanarVehicle vehicle(box_ahead());
  // The fake's camera has 160 columns over 80°, and its middle between columns 79 and 80: eight
  // columns from 76 to 83 are straight ahead.
  const RealRow ahead = measure_real_row(look_at("blue_box"), PixelBox{76, 50, 8, 8}, vehicle);
  EXPECT_NEAR(ahead.outcome.results.at("angle_error_deg"),
              std::abs(deg_from_rad(ahead.outcome.results.at("bearing_rad"))), 1e-9);
  PlanarVehicle again(box_ahead());
  // Eight columns further right.
  const RealRow right = measure_real_row(look_at("blue_box"), PixelBox{84, 50, 8, 8}, again);
  const double f_px = 80.0 / std::tan(rad_from_deg(40));
  const double moved_deg = 0.5 * deg_from_rad(std::atan(4.0 / f_px) + std::atan(12.0 / f_px));
  EXPECT_NEAR(right.outcome.results.at("angle_error_deg"),
              ahead.outcome.results.at("angle_error_deg") + moved_deg, 1e-6);
}

TEST(RealRow, SaysWhyThereIsNoReference) {
  PlanarVehicle vehicle({.anchor_bearing_rad = rad_from_deg(20)});
  const RealRow row = measure_real_row(look_at("blue_box"), std::nullopt, vehicle);
  EXPECT_TRUE(row.outcome.reached());
  EXPECT_FALSE(row.outcome.results.contains("distance_error_m"));
  ASSERT_EQ(row.notes.size(), 1u);
  EXPECT_THAT(row.notes[0], HasSubstr("no distance reference"));
}

TEST(RealRow, WithoutAnEstimateThereIsNothingToCompare) {
  PlanarVehicle vehicle({.anchor_is_there = false});
  const RealRow row = measure_real_row(look_at("blue_box"), PixelBox{0, 0, 9, 9}, vehicle);
  EXPECT_EQ(row.outcome.status, tasks::TaskStatus::kNotReached);
  EXPECT_FALSE(row.sighting);
  EXPECT_FALSE(row.outcome.results.contains("angle_error_deg"));
  PlanarVehicle other({});
  EXPECT_EQ(measure_real_row(look_at("door"), std::nullopt, other).outcome.failure,
            Failure::Kind::kInvalid);
  PlanarVehicle lost({.anchor_bearing_rad = rad_from_deg(1.0), .disconnect_at = 6});
  EXPECT_EQ(measure_real_row(look_at("blue_box"), std::nullopt, lost).outcome.failure,
            Failure::Kind::kDisconnected);
}

TEST(Table2, IncludesThePapersRow) {
  RealRow row;
  row.outcome.results = {{"angle_error_deg", 0.12345}, {"duration_s", 0.4567}};
  EXPECT_EQ(
      table_2(row, "bench-pi"),
      "Table II: relative position\n"
      "data origin    SUT location       angle error [deg]  distance error [m]  time required "
      "[s]\n"
      "real sensor    bench-pi                       0.123                   -              "
      "0.457\n"
      "paper:\n"
      "  real sensor  target, real-time              0.285               0.083              "
      "0.558\n"
      "(paper, Table II: means of ten experiments)\n");
}

TEST(PixelBox, IsTheTrackedRegion) {
  vision::Roi roi;
  roi.center = {79.5, 53.5};
  roi.width_px = 8.0;
  roi.height_px = 8.2;
  EXPECT_EQ(to_pixel_box(roi), "76,50,8,8");
}

}  // namespace
}  // namespace tether::rig
