#include "velocity_planner.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include <tether/base/units.h>

namespace tether::tasks {
namespace {

AvoidByScanOptions options() {
  AvoidByScanOptions options;
  options.speed_m_s = 2.0;
  return options;
}

/// Points every 5 cm.
std::vector<Vec2> wall(const Vec2& from, const Vec2& to) {
  std::vector<Vec2> points;
  const double length_m = std::hypot(to.x - from.x, to.y - from.y);
  for (double at_m = 0.0; at_m <= length_m; at_m += 0.05) {
    const double share = at_m / length_m;
    points.push_back({from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)});
  }
  return points;
}

TEST(PlanVelocity, FliesStraightToTheGoalIfNothingIsInTheWay) {
  const Plan plan = plan_velocity({}, {}, {10.0, 0.0}, options());
  EXPECT_DOUBLE_EQ(plan.velocity_H_m_s.x, 2.0);
  EXPECT_DOUBLE_EQ(plan.velocity_H_m_s.y, 0.0);
  EXPECT_DOUBLE_EQ(plan.hit_s, 1.5);
}

TEST(PlanVelocity, FliesAroundAnObstacle) {
  for (const double side : {1.0, -1.0}) {
    const Plan plan = plan_velocity({{1.5, -0.1 * side}}, {2.0, 0.0}, {10.0, 0.0}, options());
    EXPECT_GT(plan.clearance_m, 0.0);
    EXPECT_GT(side * plan.velocity_H_m_s.y, 0.1);
    EXPECT_GT(plan.velocity_H_m_s.x, 1.0);
  }
}

TEST(PlanVelocity, TakesTheGapThatIsWideEnough) {
  auto obstacles = wall({2.0, -5.0}, {2.0, 0.6});  // a gap of 1.4 m, and then one of 0.4 m
  const auto rest = wall({2.0, 2.0}, {2.0, 2.4});
  obstacles.insert(obstacles.end(), rest.begin(), rest.end());
  const auto far = wall({2.0, 2.8}, {2.0, 6.0});
  obstacles.insert(obstacles.end(), far.begin(), far.end());
  const Plan plan = plan_velocity(obstacles, {1.0, 1.0}, {10.0, 1.3}, options());
  EXPECT_GT(plan.clearance_m, 0.0);
  const double passes_at_m = 2.0 * plan.velocity_H_m_s.y / plan.velocity_H_m_s.x;
  EXPECT_GT(plan.velocity_H_m_s.x, 1.0);
  EXPECT_GT(passes_at_m, 0.8);
  EXPECT_LT(passes_at_m, 1.8);
}

TEST(PlanVelocity, HitsAsLateAsItCanIfItMustHit) {
  const Plan plan =
      plan_velocity(wall({0.6, -5.0}, {0.6, 5.0}), {4.0, 0.0}, {10.0, 0.0}, options());
  EXPECT_LT(plan.hit_s, 1.5);
  EXPECT_LE(plan.clearance_m, 0.0);
  EXPECT_LE(plan.velocity_H_m_s.x, 0.0) << "brakes";
}

TEST(PlanVelocity, LeavesAnObstacleThatIsNearerThanItShouldBe) {
  const Plan plan = plan_velocity({{0.3, 0.1}}, {}, {10.0, 0.0}, options());
  EXPECT_GT(plan.clearance_m, 0.0);
  EXPECT_LT(plan.velocity_H_m_s.y, -0.5);
}

TEST(ObstaclesOf, AreInTheHeadingFrameAndInTheWay) {
  const uav::SensorDescription lidar{"lidar",
                                     {{0.1, 0.0, 0.0}, {}},
                                     20.0,
                                     uav::ScanProperties{.columns = 3,
                                                         .min_azimuth_rad = -rad_from_deg(90.0),
                                                         .max_azimuth_rad = rad_from_deg(90.0),
                                                         .min_m = 0.1,
                                                         .max_m = 10.0}};
  uav::ScanSample scan;
  const float nothing = std::numeric_limits<float>::infinity();
  scan.ranges_m = {2.0F, 4.0F, nothing};
  const auto level_scan = obstacles_of(lidar, scan, {});
  ASSERT_EQ(level_scan.size(), 2u);
  EXPECT_NEAR(level_scan[0].x, 0.1, 1e-6);
  EXPECT_NEAR(level_scan[0].y, -2.0, 1e-6);
  EXPECT_NEAR(level_scan[1].x, 4.1, 1e-6);
  // Nose down by 20 degrees, the ray ahead hits the floor.
  const auto tilted = obstacles_of(lidar, scan, uav::from_rpy(0.0, rad_from_deg(20.0), 0.0));
  ASSERT_EQ(tilted.size(), 1u);
  EXPECT_NEAR(tilted[0].y, -2.0, 1e-6);
}

}  // namespace
}  // namespace tether::tasks
