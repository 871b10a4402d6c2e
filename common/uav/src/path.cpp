#include <algorithm>
#include <cmath>
#include <cstddef>

#include <tether/base/text.h>
#include <tether/base/units.h>
#include <tether/uav/path.h>

namespace tether::uav {
namespace {

/// Position and yaw together: what a spline interpolates.
struct Four {
  Vec3 p;
  double yaw = 0.0;
};
Four operator+(const Four& a, const Four& b) {
  return {a.p + b.p, a.yaw + b.yaw};
}
Four operator-(const Four& a, const Four& b) {
  return {a.p - b.p, a.yaw - b.yaw};
}
Four operator*(double s, const Four& a) {
  return {s * a.p, s * a.yaw};
}

Four value_of(const Waypoint& waypoint) {
  return {waypoint.p_m, waypoint.yaw_rad};
}

/// The slope of a spline between two chords with these slopes, where the one across both has
/// `across`: limited, so that the spline is monotone along each chord (Fritsch and Carlson 1980).
double limited(double before, double after, double across) {
  if (before * after <= 0.0) return 0.0;
  const double most = 3.0 * std::min(std::abs(before), std::abs(after));
  return std::clamp(across, -most, most);
}

/// The slope at a waypoint: that of the chord from its predecessor to its successor, limited. Where
/// there is none of them, it rests.
Four slope_at(const Path& path, std::size_t i) {
  const std::vector<Waypoint>& all = path.waypoints;
  const std::size_t last = all.size() - 1;
  const bool is_end = i == 0 || i == last;
  if (is_end && !path.repeats) return {};
  const std::size_t end = i == 0 ? last : i, begin = i == last ? 0 : i;
  const Four come = value_of(all[end]) - value_of(all[end - 1]);
  const Four go = value_of(all[begin + 1]) - value_of(all[begin]);
  const double come_s = to_seconds(all[end].at - all[end - 1].at);
  const double go_s = to_seconds(all[begin + 1].at - all[begin].at);
  const auto slope = [&](double a, double b) {
    return limited(a / come_s, b / go_s, (a + b) / (come_s + go_s));
  };
  return {{slope(come.p.x, go.p.x), slope(come.p.y, go.p.y), slope(come.p.z, go.p.z)},
          slope(come.yaw, go.yaw)};
}

PathState at_rest(const Waypoint& waypoint) {
  return {waypoint.p_m, waypoint.yaw_rad, {}, 0.0, {}, 0.0};
}

}  // namespace

std::string complaint_about(const Path& path) {
  const std::vector<Waypoint>& all = path.waypoints;
  if (all.size() < 2) return "needs two waypoints or more";
  const auto late = std::ranges::adjacent_find(
      all, [](const Waypoint& a, const Waypoint& b) { return a.at >= b.at; });
  if (late != all.end()) return "has waypoints whose times do not increase";
  if (all.front().at < Duration{0}) return "has a waypoint before 0 s";
  const auto is_jump = [](const Waypoint& a, const Waypoint& b) {
    return norm(b.p_m - a.p_m) > kFastest_m_s * to_seconds(b.at - a.at);
  };
  if (const auto jump = std::ranges::adjacent_find(all, is_jump); jump != all.end())
    return "goes from its waypoint at " + fixed(to_seconds(jump->at), 3) +
           " s to the next one faster than " + fixed(kFastest_m_s, 0) + " m/s";
  if (!path.repeats) return {};
  const Four way = value_of(all.back()) - value_of(all.front());
  constexpr double kSame = 1e-9;
  if (all.front().at != Duration{0}) return "repeats, so its first waypoint must be at 0 s";
  if (norm(way.p) > kSame || std::abs(wrap_angle_rad(way.yaw)) > kSame)
    return "repeats, so its last waypoint must be where the first one is";
  return {};
}

PathState state_at(const Path& path, Duration since_beginning) {
  const std::vector<Waypoint>& all = path.waypoints;
  const Duration round = all.back().at;
  const Duration late = since_beginning - path.delay;
  const Duration t = path.repeats ? (late % round + round) % round : late;
  if (t <= all.front().at && !path.repeats) return at_rest(all.front());
  const auto next = std::ranges::upper_bound(all, t, {}, &Waypoint::at);
  if (next == all.end()) return at_rest(all.back());
  const auto i = static_cast<std::size_t>(next - all.begin());
  const double span_s = to_seconds(all[i].at - all[i - 1].at);
  const double s = to_seconds(t - all[i - 1].at) / span_s;
  const Four from = value_of(all[i - 1]), way = value_of(all[i]) - from;
  const Four a = span_s * slope_at(path, i - 1), b = span_s * slope_at(path, i);
  // from + a s + c2 s² + c3 s³
  const Four c2 = 3.0 * way - (2.0 * a + b), c3 = (a + b) - 2.0 * way;
  const Four here = from + s * (a + s * (c2 + s * c3));
  const Four rate = (1.0 / span_s) * (a + s * (2.0 * c2 + (3.0 * s) * c3));
  const Four curve = (1.0 / (span_s * span_s)) * (2.0 * c2 + (6.0 * s) * c3);
  return {here.p, here.yaw, rate.p, rate.yaw, curve.p, curve.yaw};
}

Pose moved(const Pose& X_WM, const PathState& state) {
  return {X_WM.p + state.p_m, from_axis_angle({0, 0, 1}, state.yaw_rad) * X_WM.q};
}

}  // namespace tether::uav
