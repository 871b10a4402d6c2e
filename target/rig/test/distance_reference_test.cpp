#include "distance_reference.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include <tether/base/units.h>
#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::rig {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kNothing_m = std::numeric_limits<double>::infinity();

uav::SensorDescription mounted_at(const uav::Vec3& p_B, double yaw_rad = 0.0) {
  return {"sensor", {p_B, uav::from_rpy(0, 0, yaw_rad)}, 0.0, uav::RangeProperties{0.0, 5.0}};
}

const uav::Anchor kBox{"blue_box", uav::AnchorShape::kBox, {0.4, 0.6, 0.8}, {0, 0, 1}};

TEST(MedianOfFinite, IgnoresInfiniteReadings) {
  EXPECT_EQ(median_of_finite_m({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median_of_finite_m({kNothing_m, 1.0, -kNothing_m, 2.0}), 1.5);
  EXPECT_FALSE(median_of_finite_m({kNothing_m, 1.0, kNothing_m}));
  EXPECT_FALSE(median_of_finite_m({}));
}

TEST(ReferenceFrom, IsFromTheCameraToTheAnchorsCentre) {
  const auto camera = mounted_at({0.10, 0, 0});
  // The rangefinder is 3 cm behind the camera, and the box 0.4 m deep.
  const auto ahead = reference_from(2.0, mounted_at({0.07, 0, -0.02}), camera, kBox, 0.0);
  EXPECT_NEAR(ahead.distance_m.value(), 2.0 - 0.03 + 0.2, 1e-12);
  const uav::Anchor tube{"tube", uav::AnchorShape::kCylinder, {0.1, 0.1, 1.0}, {1, 0, 0}};
  const auto round = reference_from(2.0, mounted_at({0.12, 0, 0}), camera, tube, 0.0);
  EXPECT_NEAR(round.distance_m.value(), 2.0 + 0.02 + 0.05, 1e-12);
}

TEST(ReferenceFrom, GoesAlongTheLineOfSight) {
  const double bearing_rad = rad_from_deg(30);
  const auto camera = mounted_at({0, 0, 0});
  // Both sensors look left by 30°; what is a decimetre ahead in the body's frame is cos 30° of it
  // along their view.
  const auto reference =
      reference_from(2.0, mounted_at({0.1, 0, 0}, bearing_rad), camera, kBox, bearing_rad);
  EXPECT_NEAR(reference.distance_m.value(), 2.0 + 0.1 * std::cos(bearing_rad) + 0.2, 1e-12);
}

TEST(ReferenceFrom, IsMissingBesideTheAnchor) {
  const auto sensor = mounted_at({0, 0, 0});
  EXPECT_TRUE(reference_from(2.0, sensor, sensor, kBox, std::asin(0.29 / 2.0)).distance_m);
  const auto beside = reference_from(2.0, sensor, sensor, kBox, std::asin(0.31 / 2.0));
  EXPECT_FALSE(beside.distance_m);
  EXPECT_THAT(beside.why_none, AllOf(HasSubstr("0.31 m"), HasSubstr("0.30 m")));
}

TEST(TakeDistanceReference, ReadsTheRangefinder) {
  tasks::testing::PlanarVehicle vehicle({});
  const auto& camera = *vehicle.catalogue().find_sensor("camera");
  const auto& anchor = *vehicle.catalogue().find_anchor("blue_box");
  const auto reference = take_distance_reference(vehicle, camera, anchor, 0.0);
  ASSERT_TRUE(reference);
  EXPECT_NEAR(reference->distance_m.value(), 10.0 + 0.25, 1e-9) << "the wall at x = 10 m";
  EXPECT_EQ(vehicle.now(), ExecTime(std::chrono::milliseconds(300))) << "ten readings";

  vehicle.disturb_yaw(rad_from_deg(180));
  const auto nothing = take_distance_reference(vehicle, camera, anchor, 0.0);
  ASSERT_TRUE(nothing);
  EXPECT_FALSE(nothing->distance_m);
  EXPECT_THAT(nothing->why_none, HasSubstr("10"));
  tasks::testing::PlanarVehicle lost({.disconnect_at = 4});
  const auto failed = take_distance_reference(lost, camera, anchor, 0.0);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.failure().kind, Failure::Kind::kDisconnected);
}

}  // namespace
}  // namespace tether::rig
