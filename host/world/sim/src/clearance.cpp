// Most shapes are far away. A ball around each is compared first, then its smallest box, and only
// for what may be the nearest the exact distance of two convex shapes (convex.h).

#include "convex.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include <tether/sim/bodies.h>
#include <tether/sim/contacts.h>

namespace tether::sim {
namespace {

using uav::Pose;
using uav::Vec3;

/// Shapes that are this close touch.
constexpr double kTouching_m = 1e-3;
/// What a UAV leaves when it is lifted by this, it stands on.
constexpr double kLift_m = 0.02;
constexpr double kMostLift_m = 1.0;
/// So far below everything, nothing holds a UAV any more.
constexpr double kFallen_m = 0.5;
constexpr double kFarFromAnchors_m = 50.0;
/// More than distances are rounded by.
constexpr double kRounding_m = 1e-6;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The smallest box around a shape, in the shape's own axes.
struct Bounds {
  Vec3 centre;
  Vec3 half_m;
};

Bounds bounds_of(const Convex& shape) {
  const auto extent = [&](const Vec3& axis) {
    return dot(support_point(shape, axis), axis) + rounding_m(shape);
  };
  const Vec3 high{extent({1, 0, 0}), extent({0, 1, 0}), extent({0, 0, 1})};
  const Vec3 low{-extent({-1, 0, 0}), -extent({0, -1, 0}), -extent({0, 0, -1})};
  return {0.5 * (high + low), 0.5 * (high - low)};
}

/// How far `p_S` is outside of the box.
double distance_m(const Bounds& bounds, const Vec3& p_S) {
  const Vec3 d = p_S - bounds.centre;
  const auto beyond = [](double value, double half) {
    return std::max(0.0, std::abs(value) - half);
  };
  return norm(Vec3{beyond(d.x, bounds.half_m.x), beyond(d.y, bounds.half_m.y),
                   beyond(d.z, bounds.half_m.z)});
}

}  // namespace

struct ClearanceMeter::Shape {
  std::string_view owner;
  std::optional<std::size_t> body;  ///< of `moving_bodies`; none: fixed, and X_BS is in W
  Pose X_BS;
  const Geometry& geometry;        ///< of the world
  std::span<const Vec3> vertices;  ///< of a mesh, in `vertices_`
  std::uint32_t bits = 0;
  Bounds bounds{};
  std::optional<Vec3> plane_normal_S{};  ///< of a plane, which has no `bounds`

  Pose pose(std::span<const Pose> X_WB) const { return body ? X_WB[*body] * X_BS : X_BS; }
  Convex at(const Pose& X_WS) const { return {geometry, vertices, X_WS}; }
  /// How far a point is above the plane.
  double height_m(const Vec3& p_W) const {
    return dot(rotate(X_BS.q, *plane_normal_S), p_W - X_BS.p);
  }
};

/// A ball around a shape: all that is read of the many that are far away.
struct ClearanceMeter::Ball {
  std::optional<std::size_t> body;  ///< around its origin; none: around p_WC
  std::uint32_t bits = 0;
  Vec3 p_WC{};
  double radius_m = kInfinity;  ///< of a plane too
};

ClearanceMeter::ClearanceMeter(const World& world, const MeshVertices& vertices) : world_(world) {
  for (const FixedBody& body : fixed_bodies(world)) {
    add(*body.link, body.X_WB, std::nullopt, body.model->name, vertices);
  }
  for (const MovingBody& body : moving_bodies(world)) {
    add(*body.link, {}, starts_.size(), body.uav ? body.uav->name : body.model->name, vertices);
    starts_.push_back(body.X_WB);
  }
  of_bodies_.resize(starts_.size());
  last_nearest_.resize(starts_.size());
  has_fallen_.resize(world.uavs.size());
  lowest_m_ = lowest_m();
}

ClearanceMeter::~ClearanceMeter() = default;

void ClearanceMeter::add(const Link& link, const Pose& X_BL, std::optional<std::size_t> body,
                         std::string_view owner, const MeshVertices& vertices) {
  for (const Collision& collision : link.collisions) {
    Shape shape{owner, body, X_BL * collision.X_LC, collision.geometry, {}, collision.bits};
    if (const auto* plane = std::get_if<PlaneGeometry>(&collision.geometry)) {
      if (body) continue;  // collides with nothing
      const double length = norm(plane->normal);
      shape.plane_normal_S = length > 0.0 ? (1.0 / length) * plane->normal : Vec3{0.0, 0.0, 1.0};
    } else if (const auto* mesh = std::get_if<MeshGeometry>(&collision.geometry)) {
      if (vertices) shape.vertices = vertices_of(*mesh, vertices);
      is_complete_ = is_complete_ && !shape.vertices.empty();
      if (shape.vertices.empty()) continue;
    }
    Ball ball{.body = body, .bits = collision.bits};
    if (!shape.plane_normal_S) {
      shape.bounds = bounds_of(shape.at({}));
      const Vec3 centre = transform(shape.X_BS, shape.bounds.centre);
      ball.radius_m = norm(shape.bounds.half_m) + (body ? norm(centre) : 0.0);
      if (!body) ball.p_WC = centre;
    }
    if (body) of_bodies_.resize(*body + 1);
    if (body) of_bodies_[*body].push_back(shapes_.size());
    shapes_.push_back(shape);
    balls_.push_back(ball);
  }
}

std::span<const Vec3> ClearanceMeter::vertices_of(const MeshGeometry& mesh,
                                                  const MeshVertices& vertices) {
  const auto [known, is_new] = vertices_.try_emplace(key_of(mesh));
  if (is_new) known->second = vertices(mesh);
  return known->second;
}

std::optional<Clearance> ClearanceMeter::measure(std::size_t uav,
                                                 std::span<const Pose> X_WB) const {
  if (!is_complete_) return std::nullopt;
  Nearest nearest;
  for (const std::size_t own : of_bodies_[uav])
    find_nearest(shapes_[own], X_WB, last_nearest_[uav], nearest);
  last_nearest_[uav] = nearest.shape;
  if (nearest.distance_m == kInfinity) return std::nullopt;
  return Clearance{nearest.distance_m, shapes_[nearest.shape].owner};
}

// In a fleet, most others are far away. The shape that was the nearest before, which is compared
// first, tells how far is too far.
void ClearanceMeter::find_nearest(const Shape& own, std::span<const Pose> X_WB, std::size_t first,
                                  Nearest& nearest) const {
  const Convex here = own.at(own.pose(X_WB));
  const Ball around{.body = {},
                    .p_WC = transform(here.X_WS, own.bounds.centre),
                    .radius_m = norm(own.bounds.half_m)};
  const auto compare_to = [&](std::size_t other) {
    const double distance_m =
        distance_between(here, around, shapes_[other], X_WB, nearest.distance_m);
    nearest = std::min(nearest, {distance_m, other});
  };
  if (shapes_[first].body != own.body && (balls_[first].bits & own.bits) != 0) compare_to(first);
  for (std::size_t i = 0; i < balls_.size(); ++i) {
    const Ball& ball = balls_[i];
    if (ball.body == own.body || i == first || (ball.bits & own.bits) == 0) continue;
    const Vec3 apart_W = around.p_WC - (ball.body ? X_WB[*ball.body].p : ball.p_WC);
    const double beyond_m = nearest.distance_m + around.radius_m + ball.radius_m + kRounding_m;
    if (dot(apart_W, apart_W) <= beyond_m * beyond_m) compare_to(i);
  }
}

// Or any number above `enough_m`, if the distance is above it.
double ClearanceMeter::distance_between(const Convex& here, const Ball& around, const Shape& other,
                                        std::span<const Pose> X_WB, double enough_m) {
  if (other.plane_normal_S) {
    const Vec3 down_W = rotate(other.X_BS.q, -1.0 * *other.plane_normal_S);
    return std::max(0.0, other.height_m(support_point(here, down_W)) - rounding_m(here));
  }
  const Pose X_WS = other.pose(X_WB);
  const Vec3 centre_S = rotate(inverse(X_WS.q), around.p_WC - X_WS.p);
  const double least_m = distance_m(other.bounds, centre_S) - around.radius_m;
  return least_m > enough_m ? kInfinity : std::max(0.0, sim::distance_m(here, other.at(X_WS)));
}

// The owner of a fixed shape above the point, if there is none below it; empty: the point is not
// under the floor.
std::string_view ClearanceMeter::shape_overhead(const Vec3& p_W) const {
  std::string_view overhead;
  for (const Shape& shape : shapes_) {
    if (shape.body) continue;
    bool is_above = false;
    if (shape.plane_normal_S) {
      is_above = shape.height_m(p_W) < 0.0;
    } else {
      const Convex there = shape.at(shape.X_BS);
      const auto reach_m = [&](const Vec3& axis) {
        return dot(support_point(there, axis), axis) + rounding_m(there) - dot(p_W, axis);
      };
      const bool is_in_column = reach_m({1, 0, 0}) > 0.0 && reach_m({-1, 0, 0}) > 0.0 &&
                                reach_m({0, 1, 0}) > 0.0 && reach_m({0, -1, 0}) > 0.0;
      if (!is_in_column) continue;
      is_above = reach_m({0, 0, -1}) < 0.0;
    }
    if (!is_above) return {};
    overhead = shape.owner;
  }
  return overhead;
}

std::string_view ClearanceMeter::obstacle_of_start(std::size_t uav) const {
  if (const auto floor = shape_overhead(starts_[uav].p); !floor.empty()) return floor;
  const auto touched_at = [&](double height_m) {
    std::vector<Pose> lifted = starts_;
    lifted[uav].p.z += height_m;
    const auto clearance = measure(uav, lifted);
    return clearance && clearance->distance_m <= kTouching_m ? clearance->to : std::string_view{};
  };
  return touched_at(0.0).empty() ? std::string_view{} : touched_at(kLift_m);
}

void ClearanceMeter::warn_of_starts(const WarningSink& warn) const {
  if (!warn) return;
  for (std::size_t i = 0; i < world_.uavs.size(); ++i) {
    const auto warn_that = [&](const std::string& message) {
      warn({Consequence::kDoubtful, {}, "UAV '" + world_.uavs[i].name + "'", message});
    };
    const Vec3& p_WB = starts_[i].p;
    const std::string obstacle(obstacle_of_start(i));
    if (!shape_overhead(p_WB).empty()) {
      warn_that("starts below the floor '" + obstacle + "'; set its position_m");
    } else if (!obstacle.empty()) {
      // As a model does whose legs reach further down than its start is high.
      std::vector<Pose> lifted = starts_;
      const auto is_free = [&](double height_m) {
        lifted[i].p.z = p_WB.z + height_m;
        const auto clearance = measure(i, lifted);
        return !clearance || clearance->distance_m > kTouching_m;
      };
      double lift_m = kLift_m;
      while (lift_m < kMostLift_m && !is_free(lift_m)) lift_m += kLift_m;
      warn_that("starts inside '" + obstacle + "' or touching it; " +
                (lift_m < kMostLift_m
                     ? fmt::format("with position_m = [{:g}, {:g}, {:.2f}] it does not", p_WB.x,
                                   p_WB.y, p_WB.z + lift_m)
                     : "set its position_m"));
    }
    const PlacedAnchor* nearest = nullptr;
    for (const PlacedAnchor& anchor : world_.anchors) {
      if (!nearest || norm(anchor.X_WA.p - p_WB) < norm(nearest->X_WA.p - p_WB)) nearest = &anchor;
    }
    if (nearest && norm(nearest->X_WA.p - p_WB) > kFarFromAnchors_m)
      warn_that("starts " + std::to_string(std::lround(norm(nearest->X_WA.p - p_WB))) +
                " m from the nearest anchor, '" + nearest->anchor.name +
                "'; check its position_m and the anchor's");
  }
}

// −∞: something reaches down for ever, there is nothing, or not all of it is known.
double ClearanceMeter::lowest_m() const {
  double lowest_m = kInfinity;
  for (const Shape& shape : shapes_) {
    if (shape.body) continue;
    const Vec3 down{0.0, 0.0, -1.0};
    if (!shape.plane_normal_S)
      lowest_m = std::min(lowest_m, support_point(shape.at(shape.X_BS), down).z);
    else if (rotate(shape.X_BS.q, *shape.plane_normal_S).z > 1.0 - kRounding_m)
      lowest_m = std::min(lowest_m, shape.X_BS.p.z);
    else
      return -kInfinity;
  }
  if (lowest_m == kInfinity || !is_complete_) return -kInfinity;
  for (std::size_t i = 0; i < world_.uavs.size(); ++i)
    lowest_m = std::min(lowest_m, starts_[i].p.z);
  return lowest_m;
}

void ClearanceMeter::warn_of_falls(std::span<const Pose> X_WB, const WarningSink& warn) {
  for (std::size_t i = 0; i < world_.uavs.size(); ++i) {
    if (has_fallen_[i] || X_WB[i].p.z > lowest_m_ - kFallen_m) continue;
    has_fallen_[i] = true;
    warn({Consequence::kDoubtful,
          {},
          "UAV '" + world_.uavs[i].name + "'",
          "falls below all that the world has, as beside the edge of its floor"});
  }
}

}  // namespace tether::sim
