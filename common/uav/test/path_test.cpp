#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <tether/uav/path.h>

namespace tether::uav {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

Path square() {
  return {{{seconds(0), {0, 0, 0}, 0.0},
           {seconds(2), {2, 0, 0}, 0.5 * std::numbers::pi},
           {seconds(5), {2, 2, 1}, std::numbers::pi},
           {seconds(7), {0, 2, 0}, 1.5 * std::numbers::pi},
           {seconds(9), {0, 0, 0}, 2.0 * std::numbers::pi}},
          true};
}

TEST(Path, IsAtItsWaypointsAtTheirTimes) {
  Path path = square();
  for (const bool repeats : {true, false}) {
    path.repeats = repeats;
    for (std::size_t i = 0; i + 1 < path.waypoints.size(); ++i) {
      const PathState state = state_at(path, path.waypoints[i].at);
      EXPECT_LT(norm(state.p_m - path.waypoints[i].p_m), 1e-12) << i;
      EXPECT_NEAR(state.yaw_rad, path.waypoints[i].yaw_rad, 1e-12) << i;
    }
  }
}

TEST(Path, VelocityAndAccelerationAreTheDerivativesOfThePosition) {
  const Path path = square();
  constexpr Duration kHalf = std::chrono::microseconds(50);
  for (Duration t = milliseconds(1); t < seconds(20); t += milliseconds(37)) {
    const bool is_at_a_waypoint = std::ranges::any_of(path.waypoints, [&](const Waypoint& w) {
      return std::chrono::abs(t % path.waypoints.back().at - w.at) <= kHalf;
    });
    if (is_at_a_waypoint) continue;
    const PathState before = state_at(path, t - kHalf), now = state_at(path, t),
                    after = state_at(path, t + kHalf);
    const double span_s = to_seconds(2 * kHalf);
    EXPECT_LT(norm((1.0 / span_s) * (after.p_m - before.p_m) - now.v_m_s), 1e-6);
    EXPECT_NEAR((after.yaw_rad - before.yaw_rad) / span_s, now.yaw_rate_rad_s, 1e-6);
    EXPECT_LT(norm((1.0 / span_s) * (after.v_m_s - before.v_m_s) - now.a_m_s2), 1e-6);
    EXPECT_NEAR((after.yaw_rate_rad_s - before.yaw_rate_rad_s) / span_s,
                now.yaw_acceleration_rad_s2, 1e-6);
  }
}

TEST(Path, VelocitiesDoNotJumpAtWaypoints) {
  for (const Waypoint& waypoint : square().waypoints) {
    const Duration at = waypoint.at + square().waypoints.back().at;
    const PathState before = state_at(square(), at - Duration(1)), after = state_at(square(), at);
    EXPECT_LT(norm(after.v_m_s - before.v_m_s), 1e-6);
    EXPECT_NEAR(after.yaw_rate_rad_s, before.yaw_rate_rad_s, 1e-6);
  }
}

TEST(Path, RestsBetweenEqualWaypoints) {
  const Path path{{{seconds(0), {0, 0, 0}, 0.0},
                   {seconds(4), {4, 1, 0}, 0.5},
                   {seconds(6), {4, 1, 0}, 0.5},
                   {seconds(9), {8, -2, 1}, 1.5}},
                  false};
  for (Duration t = seconds(4); t <= seconds(6); t += milliseconds(50)) {
    const PathState state = state_at(path, t);
    EXPECT_EQ(state.p_m, (Vec3{4, 1, 0}));
    EXPECT_EQ(state.v_m_s, Vec3{});
    EXPECT_EQ(state.yaw_rate_rad_s, 0.0);
  }
}

// Also where a slow leg is followed by a fast one, whose slope would first swing back.
TEST(Path, StaysBetweenTwoNeighboursAlongEachAxis) {
  Path path{{{seconds(0), {0, 0, 0}, 0.0},
             {seconds(10), {1, 3, 0}, 0.1},
             {seconds(11), {9, -3, 2}, 2.0},
             {seconds(19), {10, -4, 2}, 0.0},
             {seconds(20), {0, 0, 0}, 0.0}},
            true};
  for (const bool repeats : {true, false}) {
    path.repeats = repeats;
    for (std::size_t i = 1; i < path.waypoints.size(); ++i) {
      const Waypoint &from = path.waypoints[i - 1], &to = path.waypoints[i];
      for (Duration t = from.at; t < to.at; t += milliseconds(10)) {
        const PathState state = state_at(path, t);
        const auto expect_between = [&](double a, double b, double value) {
          EXPECT_GE(value, std::min(a, b) - 1e-12) << i;
          EXPECT_LE(value, std::max(a, b) + 1e-12) << i;
        };
        expect_between(from.p_m.x, to.p_m.x, state.p_m.x);
        expect_between(from.p_m.y, to.p_m.y, state.p_m.y);
        expect_between(from.p_m.z, to.p_m.z, state.p_m.z);
        expect_between(from.yaw_rad, to.yaw_rad, state.yaw_rad);
      }
    }
  }
}

TEST(Path, RestsBeforeItsFirstAndAfterItsLastWaypoint) {
  const Path path{{{seconds(1), {1, 2, 3}, 0.1}, {seconds(2), {4, 5, 6}, 0.2}}, false};
  for (const auto& [at, waypoint] : {std::pair{milliseconds(0), path.waypoints[0]},
                                     std::pair{milliseconds(2500), path.waypoints[1]}}) {
    const PathState state = state_at(path, at);
    EXPECT_EQ(state.p_m, waypoint.p_m);
    EXPECT_EQ(state.v_m_s, Vec3{});
    EXPECT_EQ(state.yaw_rate_rad_s, 0.0);
  }
}

TEST(Path, ADelayMakesAllOfItLater) {
  Path path = square();
  path.delay = milliseconds(8500);
  EXPECT_EQ(state_at(path, seconds(1)).p_m, state_at(square(), milliseconds(1500)).p_m);
  EXPECT_EQ(state_at(path, seconds(10)).p_m, state_at(square(), milliseconds(1500)).p_m);
}

TEST(Path, TurnsAboutThePlaceWhereItWasPut) {
  const Pose X_WM{{1, 0, 0}, from_axis_angle({1, 0, 0}, 0.3)};
  const Pose moved_by = moved(X_WM, {{0, 2, 0}, 0.5 * std::numbers::pi, {}, 0.0, {}, 0.0});
  EXPECT_EQ(moved_by.p, (Vec3{1, 2, 0}));
  EXPECT_LT(norm(rotate(moved_by.q, {1, 0, 0}) - Vec3{0, 1, 0}), 1e-12);
}

TEST(Path, AnImpossibleOneIsNamed) {
  EXPECT_EQ(complaint_about(square()), "");
  EXPECT_NE(complaint_about({{{seconds(1), {}, 0.0}}, false}), "");
  EXPECT_NE(complaint_about({{{seconds(1), {}, 0.0}, {seconds(1), {}, 0.0}}, false}), "");
  EXPECT_NE(complaint_about({{{seconds(0), {}, 0.0}, {seconds(1), {1, 0, 0}, 0.0}}, true}), "");
  EXPECT_NE(complaint_about({{{seconds(1), {}, 0.0}, {seconds(2), {}, 0.0}}, true}), "");
}

}  // namespace
}  // namespace tether::uav
