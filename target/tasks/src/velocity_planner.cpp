#include "velocity_planner.h"

#include "motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <tether/base/time.h>

namespace tether::tasks {
namespace {

/// Higher or lower than this, a hit is the floor or what the UAV passes above or below [m].
constexpr double kReach_m = 0.6;
/// A metre of clearance that is missing costs as much as so many metres of way.
constexpr double kPriceOfClearance = 4.0;
/// If an obstacle is within the radius already, a path must not come nearer to it than this [m].
constexpr double kNoNearer_m = 0.02;
/// Worse than any way that hits nothing.
constexpr double kHit = -1e6;

double distance_m(const Vec2& a, const Vec2& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

double nearest_m(const std::vector<Vec2>& obstacles, const Vec2& p) {
  double least_m2 = std::numeric_limits<double>::infinity();
  for (const Vec2& obstacle : obstacles) {
    const double dx = obstacle.x - p.x;
    const double dy = obstacle.y - p.y;
    least_m2 = std::min(least_m2, dx * dx + dy * dy);
  }
  return std::sqrt(least_m2);
}

/// `v` after a step towards `wanted`.
Vec2 accelerated(const Vec2& v, const Vec2& wanted, double most_m_s) {
  const double change_m_s = distance_m(wanted, v);
  if (change_m_s <= most_m_s) return wanted;
  const double share = most_m_s / change_m_s;
  return {v.x + share * (wanted.x - v.x), v.y + share * (wanted.y - v.y)};
}

struct Prediction {
  Plan plan;
  Vec2 end;
};

Prediction predict(const std::vector<Vec2>& obstacles, Vec2 velocity, const Vec2& wanted,
                   const AvoidByScanOptions& options) {
  const double step_s = to_seconds(options.step);
  const double horizon_s = to_seconds(options.horizon);
  Prediction result{{wanted, std::numeric_limits<double>::infinity(), horizon_s}, {}};
  const double reaction_s = to_seconds(options.reaction);
  for (double at_s = step_s; at_s <= horizon_s; at_s += step_s) {
    if (at_s > reaction_s)
      velocity = accelerated(velocity, wanted, step_s * options.max_acceleration_m_s2);
    result.end = {result.end.x + step_s * velocity.x, result.end.y + step_s * velocity.y};
    const double clearance_m = nearest_m(obstacles, result.end) - options.radius_m;
    result.plan.clearance_m = std::min(result.plan.clearance_m, clearance_m);
    if (clearance_m > 0.0) continue;
    result.plan.hit_s = at_s;
    break;
  }
  return result;
}

double value_of(const Prediction& prediction, const Vec2& goal, const AvoidByScanOptions& options) {
  if (prediction.plan.clearance_m <= 0.0) return kHit + prediction.plan.hit_s;
  const double missing_m = std::max(options.margin_m - prediction.plan.clearance_m, 0.0);
  return -distance_m(prediction.end, goal) - kPriceOfClearance * missing_m;
}

}  // namespace

std::vector<Vec2> obstacles_of(const uav::SensorDescription& lidar, const uav::ScanSample& scan,
                               const uav::Quat& q_HB) {
  const auto& rays = std::get<uav::ScanProperties>(lidar.properties);
  const auto angle = [](double first, double last, int index, int count) {
    return count > 1 ? first + (last - first) * index / (count - 1) : 0.5 * (first + last);
  };
  std::vector<Vec2> obstacles;
  std::size_t ray = 0;
  for (int row = 0; row < rays.rows; ++row) {
    const double elevation_rad =
        angle(rays.min_elevation_rad, rays.max_elevation_rad, row, rays.rows);
    for (int column = 0; column < rays.columns && ray < scan.ranges_m.size(); ++column, ++ray) {
      const double range_m = scan.ranges_m[ray];
      if (!std::isfinite(range_m)) continue;
      const uav::Vec3 across =
          level(angle(rays.min_azimuth_rad, rays.max_azimuth_rad, column, rays.columns));
      const uav::Vec3 hit_S = range_m * (std::cos(elevation_rad) * across +
                                         uav::Vec3{0.0, 0.0, std::sin(elevation_rad)});
      const uav::Vec3 hit_H = rotate(q_HB, transform(lidar.X_BS, hit_S));
      if (std::abs(hit_H.z) <= kReach_m) obstacles.push_back({hit_H.x, hit_H.y});
    }
  }
  return obstacles;
}

Plan plan_velocity(const std::vector<Vec2>& obstacles, const Vec2& velocity_H_m_s,
                   const Vec2& goal_H_m, const AvoidByScanOptions& wanted) {
  AvoidByScanOptions options = wanted;
  options.radius_m = std::min(options.radius_m, nearest_m(obstacles, {}) - kNoNearer_m);
  Prediction best = predict(obstacles, velocity_H_m_s, {}, options);
  double best_value = value_of(best, goal_H_m, options);
  for (int direction = 0; direction < options.directions; ++direction) {
    const uav::Vec3 along = level(2.0 * std::numbers::pi * direction / options.directions);
    for (int speed = 1; speed <= options.speeds; ++speed) {
      const double speed_m_s = options.speed_m_s * speed / options.speeds;
      const Prediction one =
          predict(obstacles, velocity_H_m_s, {speed_m_s * along.x, speed_m_s * along.y}, options);
      const double value = value_of(one, goal_H_m, options);
      if (value <= best_value) continue;
      best = one;
      best_value = value;
    }
  }
  return best.plan;
}

}  // namespace tether::tasks
