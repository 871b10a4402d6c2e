#include <gtest/gtest.h>

#include <tether/sim_gazebo_plugin/shape_rays.h>

namespace tether::gazebo_plugin {
namespace {

using uav::Pose;
using uav::Vec3;

void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_LT(norm(a - b), 1e-12) << a.x << " " << a.y << " " << a.z;
}

TEST(RayFrames, PointASensorsRaysIntoTheWorld) {
  const Pose X_WS{{1, 2, 3}, uav::from_axis_angle({0, 0, 1}, 1.5707963267948966)};
  const Ray ray = ray_in_world(X_WS, {1, 0, 0});
  expect_near(ray.origin, {1, 2, 3});
  expect_near(ray.direction, {0, 1, 0});
}

TEST(RayFrames, SeeABodyThatHasMovedWhereItWas) {
  const Pose given{{1, 0, 0}, uav::from_rpy(0.1, 0.2, 0.3)};
  const Pose now{{-2, 5, 1}, uav::from_rpy(-0.4, 0.6, 2.0)};
  const Ray ray{{4, 1, 2}, uav::rotate(uav::from_rpy(0, 0.5, 2.5), {1, 0, 0})};
  const Ray there = ray_to_body_now(ray, given, now);
  // In the body's own frame both are the same ray.
  expect_near(transform(inverse(now), there.origin), transform(inverse(given), ray.origin));
  expect_near(rotate(inverse(now.q), there.direction), rotate(inverse(given.q), ray.direction));
}

TEST(RayFrames, LeaveARayToABodyThatStands) {
  const Pose X{{1, 2, 3}, uav::from_rpy(0.3, 0.2, 0.1)};
  const Ray ray = ray_to_body_now({{4, 5, 6}, {0, 0, 1}}, X, X);
  expect_near(ray.origin, {4, 5, 6});
  expect_near(ray.direction, {0, 0, 1});
}

}  // namespace
}  // namespace tether::gazebo_plugin
