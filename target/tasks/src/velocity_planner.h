#pragma once

#include <vector>

#include <tether/tasks/mission_tasks.h>
#include <tether/uav/math.h>
#include <tether/uav/samples.h>

namespace tether::tasks {

/// A point or a vector of the horizontal plane.
struct Vec2 {
  double x = 0.0, y = 0.0;
};

/// What a scan hits, from the body's origin, in the heading frame H [m]. Hits that are far above or
/// below the UAV are left out: they are not in its way.
/// @param q_HB attitude of the body at the scan's instant
std::vector<Vec2> obstacles_of(const uav::SensorDescription& lidar, const uav::ScanSample& scan,
                               const uav::Quat& q_HB);

/// A velocity, and what it would lead to.
struct Plan {
  Vec2 velocity_H_m_s;
  double clearance_m = 0.0;  ///< least distance to an obstacle, until the horizon or the hit
  double hit_s = 0.0;        ///< when it comes too near to one; the horizon: never
};

/// The best velocity by the dynamic window approach (Fox, Burgard, Thrun: "The dynamic window
/// approach to collision avoidance", IEEE Robotics & Automation Magazine 4(1), 1997), for a UAV
/// that can fly into any direction: it predicts the path for each velocity of a grid, from the
/// velocity that the UAV has, and takes the one that ends nearest to the goal, minus a price for
/// small clearances. If all of them hit something, it takes the one that does so last.
///
/// Obstacles and velocities are in H, the goal is relative to the UAV. Pure arithmetic; computes
/// directions × speeds × steps × obstacles distances.
Plan plan_velocity(const std::vector<Vec2>& obstacles, const Vec2& velocity_H_m_s,
                   const Vec2& goal_H_m, const AvoidByScanOptions& wanted);

}  // namespace tether::tasks
