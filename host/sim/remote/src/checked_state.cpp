#include "checked_state.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

/// Of a length in a world's file, too.
constexpr double kFarthestBody_m = 1e5;
constexpr double kUavTolerance = 1e-6;
/// What is in contact is pushed apart a little before the first state.
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
  for (const Uav& uav : world.uavs) names.push_back("UAV '" + uav.name + "'");
  for (const Model& model : world.models) {
    if (model.is_static) continue;
    for (const Link& link : model.links)
      names.push_back("link '" + link.name + "' of model '" + model.name + "'");
  }
  return names;
}

/// Where messages come from.
struct Source {
  const World& world;
  const std::string& simulator;
};

[[noreturn]] void refuse(const Source& source, std::size_t body, const std::string& what) {
  throw Error(ErrorCode::kSetup,
              source.simulator + ": " + shown_names(source.world).at(body) + " " + what);
}

bool is_near(const uav::Vec3& p) {
  return difference(p, {}) <= kFarthestBody_m;
}

}  // namespace

void check_reach(const World& world, const protocol::State& state, const std::string& simulator) {
  const Source source{world, simulator};
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    const uav::Vec3& p_WB = state.bodies[i].p_WB;
    if (!is_near(p_WB)) refuse(source, i, "is at " + shown(p_WB) + " m, beyond 1e5 m");
  }
  for (std::size_t i = 0; i < state.past.size(); ++i) {
    const uav::Vec3& p_WB = state.past[i].p;
    if (!is_near(p_WB))
      refuse(source, i % state.bodies.size(), "was at " + shown(p_WB) + " m, beyond 1e5 m");
  }
}

void check_start(const World& world, const protocol::State& state, const std::string& simulator) {
  const Source source{world, simulator};
  const std::vector<MovingBody> bodies = moving_bodies(world);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const uav::Pose& expected = bodies[i].X_WB;
    const uav::BodyState& got = state.bodies.at(i);
    const bool is_uav = bodies[i].uav != nullptr;
    const double tolerance = is_uav ? kUavTolerance : kBodyTolerance;
    if (difference(got.p_WB, expected.p) > tolerance ||
        difference(got.q_WB, expected.q) > tolerance)
      refuse(
          source, i,
          "begins at " + shown(uav::Pose{got.p_WB, got.q_WB}) + " instead of " + shown(expected));
    if (!is_uav) continue;
    if (difference(got.v_WB, {}) > tolerance || difference(got.w_WB_B, {}) > tolerance)
      refuse(source, i,
             "does not begin at rest: it moves with " +
                 shown("v_WB", {got.v_WB.x, got.v_WB.y, got.v_WB.z}) + " m/s, " +
                 shown("w_WB_B", {got.w_WB_B.x, got.w_WB_B.y, got.w_WB_B.z}) + " rad/s");
  }
}

}  // namespace tether::sim
