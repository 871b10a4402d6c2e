#include "flight.h"
#include "motion.h"
#include "velocity_planner.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>

#include <tether/tasks/mission_tasks.h>

namespace tether::tasks {
namespace {

constexpr double kPillar_m = 0.2;  // radius

/// A UAV with a lidar and an odometry, in a world of round pillars; each scan takes its computer so
/// long.
class ScanningVehicle : public testing::PlanarVehicle {
 public:
  ScanningVehicle(std::vector<Vec2> pillars, Duration computing)
      : PlanarVehicle({.start_yaw_rad = 0.3, .max_acceleration_m_s2 = 3.0}),
        pillars_(std::move(pillars)),
        computing_(computing),
        catalogue_(PlanarVehicle::catalogue()) {
    catalogue_.sensors.push_back({"lidar",
                                  {},
                                  20.0,
                                  uav::ScanProperties{.columns = 360,
                                                      .min_azimuth_rad = -std::numbers::pi,
                                                      .max_azimuth_rad = std::numbers::pi,
                                                      .max_m = 5.0}});
    catalogue_.sensors.push_back({"odometry", {}, 100.0, uav::OdometryProperties{}});
  }

  const uav::Catalogue& catalogue() const override { return catalogue_; }
  Result<uav::Sample> read_any(std::string_view sensor, uav::SensorKind kind,
                               client::Read read) override {
    if (kind == uav::SensorKind::kOdometry) {
      uav::OdometrySample sample;
      sample.p_WS = position();
      sample.q_WS = uav::from_axis_angle({0, 0, 1}, yaw());
      sample.v_WS_m_s = velocity_m_s_;
      return uav::Sample(sample);
    }
    if (kind != uav::SensorKind::kScan) return PlanarVehicle::read_any(sensor, kind, read);
    const uav::Vec3 before = position();
    wait(kPeriod);
    velocity_m_s_ = (1.0 / to_seconds(kPeriod)) * (position() - before);
    const uav::ScanSample sample = scan();
    wait(computing_);
    return uav::Sample(sample);
  }

  /// The least distance to a pillar so far [m].
  double nearest_m() const { return nearest_m_; }

 private:
  static constexpr Duration kPeriod = std::chrono::milliseconds(50);

  void wait(Duration time) {
    constexpr Duration kSlice = std::chrono::milliseconds(10);
    for (Duration waited{0}; waited < time; waited += kSlice) {
      EXPECT_TRUE(sleep_for(kSlice));
      for (const Vec2& pillar : pillars_)
        nearest_m_ = std::min(
            nearest_m_, std::hypot(pillar.x - position().x, pillar.y - position().y) - kPillar_m);
    }
  }
  uav::ScanSample scan() const {
    uav::ScanSample sample;
    for (int ray = 0; ray < 360; ++ray) {
      const double azimuth_rad = yaw() - std::numbers::pi + 2.0 * std::numbers::pi * ray / 359.0;
      sample.ranges_m.push_back(static_cast<float>(range_m(azimuth_rad)));
    }
    return sample;
  }
  double range_m(double azimuth_rad) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec2& pillar : pillars_) {
      const double x = pillar.x - position().x, y = pillar.y - position().y;
      const double along = x * std::cos(azimuth_rad) + y * std::sin(azimuth_rad);
      const double across = y * std::cos(azimuth_rad) - x * std::sin(azimuth_rad);
      if (along <= 0.0 || std::abs(across) >= kPillar_m) continue;
      const double range = along - std::sqrt(kPillar_m * kPillar_m - across * across);
      if (range <= 5.0) least = std::min(least, range);
    }
    return least;
  }

  std::vector<Vec2> pillars_;
  Duration computing_;
  uav::Catalogue catalogue_;
  uav::Vec3 velocity_m_s_;
  double nearest_m_ = std::numeric_limits<double>::infinity();
};

struct Crossing {
  TaskOutcome outcome;
  double nearest_m = 0.0;
  double ahead_m = 0.0;  ///< at the end, along the heading at the start
};

/// The pillars are given along the heading at the start.
Crossing cross(const std::vector<Vec2>& pillars_H0, Duration computing,
               const AvoidByScanOptions& options) {
  std::vector<Vec2> pillars;
  for (const Vec2& pillar : pillars_H0) {
    const uav::Vec3 p = rotate(uav::from_axis_angle({0, 0, 1}, 0.3), {pillar.x, pillar.y, 0.0});
    pillars.push_back({p.x, p.y});
  }
  ScanningVehicle vehicle(pillars, computing);
  TaskContext context(vehicle);
  AvoidByScanTask task(options);
  Crossing crossing{run(task, context)};
  EXPECT_EQ(vehicle.commands().back(), uav::VelocityCommand{}) << "not stopped";
  crossing.nearest_m = vehicle.nearest_m();
  crossing.ahead_m = dot(vehicle.position(), level(0.3));
  return crossing;
}

const std::vector<Vec2> kField = {{2.5, 0.1}, {2.5, 1.6}, {4.5, -0.8}, {4.5, 0.8}, {6.5, 0.0}};

TEST(AvoidByScanTask, CrossesAFieldWithoutTouchingIt) {
  const Crossing crossing = cross(kField, Duration(0), {.distance_m = 8.0, .speed_m_s = 2.0});
  ASSERT_TRUE(crossing.outcome.reached()) << crossing.outcome.reason;
  EXPECT_GT(crossing.nearest_m, 0.26);
  EXPECT_GE(crossing.ahead_m, 8.0);
  EXPECT_GT(crossing.outcome.results.at("scans"), 50.0);
}

// Between two scans it flies 4 m, nearly as far as the lidar looks.
TEST(AvoidByScanTask, HitsWhatASlowComputerSeesTooLate) {
  const std::vector<Vec2> pillar = {{9.0, 0.0}};
  const AvoidByScanOptions options{.distance_m = 12.0, .speed_m_s = 4.0};
  EXPECT_GT(cross(pillar, Duration(0), options).nearest_m, 0.26);
  EXPECT_LT(cross(pillar, std::chrono::seconds(1), options).nearest_m, 0.1);
}

TEST(AvoidByScanTask, EndsAtItsLimits) {
  std::vector<Vec2> closed;
  for (double y = -20.0; y <= 20.0; y += 0.3) closed.push_back({3.0, y});
  const Crossing crossing = cross(closed, Duration(0), {.time_limit = std::chrono::seconds(4)});
  EXPECT_EQ(crossing.outcome.reason, "time limit");
  EXPECT_GT(crossing.nearest_m, 0.2);
  AvoidByScanTask blind;
  EXPECT_EQ(fly(blind, {}).outcome.status, TaskStatus::kFailed);
}

}  // namespace
}  // namespace tether::tasks
