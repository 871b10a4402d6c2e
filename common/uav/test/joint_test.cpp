#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <tether/uav/setpoint.h>

namespace tether::uav {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;

// A yaw joint below the body, then a pitch joint ahead of it.
const std::vector<Joint> kGimbal = {{"yaw", {0.1, 0, 0}, {0, 0, 1}, -2, 2, 1.5},
                                    {"pitch", {0.2, 0, -0.1}, {0, 1, 0}, -0.5, kQuarter, 2}};

void expect_at(const Vec3& a, const Vec3& b) {
  EXPECT_LT(norm(a - b), 1e-12) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(Joint, TurnsAtItsRateAndStopsAtTheTarget) {
  const Joint& pitch = kGimbal[1];
  EXPECT_DOUBLE_EQ(turned_rad(pitch, 0.25, 1.0, 0.125), 0.5);
  EXPECT_DOUBLE_EQ(turned_rad(pitch, 0.25, -1.0, 0.125), 0.0);
  EXPECT_DOUBLE_EQ(turned_rad(pitch, 0.25, 0.375, 0.125), 0.375);
}

TEST(Joint, StartsAtZeroOrNextToIt) {
  EXPECT_EQ(start_rad({.name = "", .p_BJ = {}, .axis_B = {}, .min_rad = -1, .max_rad = 1}), 0.0);
  EXPECT_EQ(start_rad({.name = "", .p_BJ = {}, .axis_B = {}, .min_rad = 0.5, .max_rad = 1}), 0.5);
  EXPECT_EQ(start_rad({.name = "", .p_BJ = {}, .axis_B = {}, .min_rad = -2, .max_rad = -1}), -1.0);
}

TEST(Joint, ThatIsBehindOthersIsTurnedByThem) {
  const Pose camera{{0.3, 0, -0.1}, {}};
  expect_at(turned(kGimbal, {}, camera).p, camera.p);

  const std::vector<double> left = {kQuarter};
  const Pose looks_left = turned(kGimbal, left, camera);
  expect_at(looks_left.p, {0.1, 0.2, -0.1});
  expect_at(rotate(looks_left.q, {1, 0, 0}), {0, 1, 0});

  // The pitch joint and the camera lie 0.1 m and 0.2 m to the left then; it turns about -x.
  const std::vector<double> left_and_down = {kQuarter, kQuarter};
  const Pose looks_down = turned(kGimbal, left_and_down, camera);
  expect_at(looks_down.p, {0.1, 0.1, -0.2});
  expect_at(rotate(looks_down.q, {1, 0, 0}), {0, 0, -1});
  expect_at(rotate(looks_down.q, {0, 1, 0}), {-1, 0, 0});
}

}  // namespace
}  // namespace tether::uav
