#include "checked_state.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

/// The same as for positions in a world's file.
constexpr double kFarthestBody_m = 1e5;
constexpr double kUavTolerance = 1e-6;
/// Bodies in contact are pushed apart a little before the first state.
constexpr double kBodyTolerance = 1e-3;

std::string shown(const std::string& name, std::initializer_list<double> numbers) {
  std::string out = name + " (";
  for (const double number : numbers) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.9g", number);
    out += digits + std::string(" ");
  }
  out.back() = ')';
  return out;
}
std::string shown(const uav::Vec3& p) {
  return shown("p_WB", {p.x, p.y, p.z});
}
std::string shown(const uav::Pose& X) {
  return shown(X.p) + ", " + shown("q_WB", {X.q.w, X.q.x, X.q.y, X.q.z});
}

double difference(const uav::Vec3& a, const uav::Vec3& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}
/// q and -q are one rotation.
double difference(const uav::Quat& a, const uav::Quat& b) {
  const double sign = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z < 0.0 ? -1.0 : 1.0;
  return std::max({std::abs(a.w - sign * b.w), std::abs(a.x - sign * b.x),
                   std::abs(a.y - sign * b.y), std::abs(a.z - sign * b.z)});
}

std::vector<std::string> shown_names(const World& world) {
  std::vector<std::string> names;
  for (const MovingBody& body : moving_bodies(world))
    names.push_back(body.uav
                        ? "UAV '" + body.uav->name + "'"
                        : "link '" + body.link->name + "' of model '" + body.model->name + "'");
  return names;
}

[[noreturn]] void refuse(const World& world, const std::string& simulator, std::size_t body,
                         const std::string& what) {
  const std::string name = shown_names(world).at(body);
  throw Error(ErrorCode::kSetup, simulator + ": " + name + " " + what).about(name);
}

}  // namespace

void check_reach(const World& world, const protocol::State& state, const std::string& simulator) {
  const auto check = [&](std::size_t body, const uav::Vec3& p_WB) {
    if (difference(p_WB, {}) > kFarthestBody_m)
      refuse(world, simulator, body, "is at " + shown(p_WB) + " m; at most 1e5 m are allowed");
  };
  for (std::size_t i = 0; i < state.bodies.size(); ++i) check(i, state.bodies[i].p_WB);
  for (std::size_t i = 0; i < state.past.size(); ++i)
    check(i % state.bodies.size(), state.past[i].p);
}

void check_start(const World& world, const protocol::State& state, const std::string& simulator) {
  const std::vector<MovingBody> bodies = moving_bodies(world);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const uav::Pose& expected = bodies[i].X_WB;
    const uav::BodyState& got = state.bodies.at(i);
    const bool is_uav = bodies[i].uav != nullptr;
    const double tolerance = is_uav ? kUavTolerance : kBodyTolerance;
    if (difference(got.p_WB, expected.p) > tolerance ||
        difference(got.q_WB, expected.q) > tolerance)
      refuse(
          world, simulator, i,
          "starts at " + shown(uav::Pose{got.p_WB, got.q_WB}) + " instead of " + shown(expected));
    if (!is_uav) continue;
    if (difference(got.v_WB, {}) > tolerance || difference(got.w_WB_B, {}) > tolerance)
      refuse(world, simulator, i,
             "does not start at rest: " + shown("v_WB", {got.v_WB.x, got.v_WB.y, got.v_WB.z}) +
                 " m/s, " + shown("w_WB_B", {got.w_WB_B.x, got.w_WB_B.y, got.w_WB_B.z}) + " rad/s");
  }
}

}  // namespace tether::sim
