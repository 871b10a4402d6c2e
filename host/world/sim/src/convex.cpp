#include "convex.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace tether::sim {
namespace {

using uav::Vec3;

constexpr int kMostIterations = 100;
constexpr double kRelativeError = 1e-6;
constexpr double kMeeting_m = 1e-9;

double with_sign_of(double direction, double value) {
  return direction < 0.0 ? -value : value;
}

Vec3 farthest(std::span<const Vec3> points, const Vec3& d) {
  return *std::ranges::max_element(points, {}, [&](const Vec3& p) { return dot(p, d); });
}

Vec3 core_point(const Convex& shape, const Vec3& d) {
  return std::visit(
      Visitor{
          [&](const BoxGeometry& g) {
            return Vec3{with_sign_of(d.x, 0.5 * g.size_m.x), with_sign_of(d.y, 0.5 * g.size_m.y),
                        with_sign_of(d.z, 0.5 * g.size_m.z)};
          },
          [&](const CylinderGeometry& g) {
            const double across = std::hypot(d.x, d.y);
            const double scale = across > 0.0 ? g.radius_m / across : 0.0;
            return Vec3{scale * d.x, scale * d.y, with_sign_of(d.z, 0.5 * g.length_m)};
          },
          [&](const SphereGeometry&) { return Vec3{}; },
          [&](const CapsuleGeometry& g) {
            return Vec3{0.0, 0.0, with_sign_of(d.z, 0.5 * g.length_m)};
          },
          [&](const EllipsoidGeometry& g) {
            const Vec3 scaled{g.radii_m.x * d.x, g.radii_m.y * d.y, g.radii_m.z * d.z};
            const double length = norm(scaled);
            const double scale = length > 0.0 ? 1.0 / length : 0.0;
            return Vec3{scale * g.radii_m.x * scaled.x, scale * g.radii_m.y * scaled.y,
                        scale * g.radii_m.z * scaled.z};
          },
          [&](const PlaneGeometry&) { return Vec3{}; },
          [&](const MeshGeometry&) { return farthest(shape.vertices, d); },
      },
      shape.geometry);
}

/// Up to four points whose convex hull is nearest to the origin.
struct Simplex {
  std::array<Vec3, 4> points;
  std::size_t size = 0;
};

/// The best sub-simplex so far.
struct Nearest {
  Simplex simplex;
  Vec3 point;
  double square = std::numeric_limits<double>::infinity();

  void offer(std::initializer_list<Vec3> points, const Vec3& nearest) {
    const double candidate = dot(nearest, nearest);
    if (!(candidate < square)) return;
    square = candidate;
    point = nearest;
    simplex.size = points.size();
    std::ranges::copy(points, simplex.points.begin());
  }
};

void offer_edge(Nearest& nearest, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double t = -dot(a, ab) / dot(ab, ab);
  if (t > 0.0 && t < 1.0) nearest.offer({a, b}, a + t * ab);
}

void offer_face(Nearest& nearest, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = cross(b - a, c - a);
  const double square = dot(n, n);
  const double u = dot(cross(b, c), n), v = dot(cross(c, a), n), w = dot(cross(a, b), n);
  if (square > 0.0 && u > 0.0 && v > 0.0 && w > 0.0)
    nearest.offer({a, b, c}, (dot(a, n) / square) * n);
}

// Whether the origin is on the same side of the face a, b, c as d.
bool is_on_side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 n = cross(b - a, c - a);
  return dot(n, a) * dot(n, a - d) > 0.0;
}

bool holds_origin(const Simplex& s) {
  const auto& [a, b, c, d] = s.points;
  return s.size == 4 && is_on_side(a, b, c, d) && is_on_side(b, c, d, a) &&
         is_on_side(c, d, a, b) && is_on_side(d, a, b, c);
}

Nearest nearest_to_origin(const Simplex& s) {
  Nearest nearest;
  for (std::size_t i = 0; i < s.size; ++i) {
    const Vec3& a = s.points[i];
    nearest.offer({a}, a);
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3& b = s.points[j];
      offer_edge(nearest, a, b);
      for (std::size_t k = 0; k < j; ++k) offer_face(nearest, a, b, s.points[k]);
    }
  }
  return nearest;
}

}  // namespace

Vec3 support_point(const Convex& shape, const Vec3& d_W) {
  return transform(shape.X_WS, core_point(shape, rotate(inverse(shape.X_WS.q), d_W)));
}

double rounding_m(const Convex& shape) {
  if (const auto* sphere = std::get_if<SphereGeometry>(&shape.geometry)) return sphere->radius_m;
  const auto* capsule = std::get_if<CapsuleGeometry>(&shape.geometry);
  return capsule != nullptr ? capsule->radius_m : 0.0;
}

// The simplex is one of points of the shapes' difference, and moves towards the origin until no
// point of the difference is nearer.
double distance_m(const Convex& a, const Convex& b) {
  const double rounding = rounding_m(a) + rounding_m(b);
  const auto farthest_along = [&](const Vec3& d) {
    return support_point(a, d) - support_point(b, -1.0 * d);
  };
  Nearest nearest;
  const Vec3 first = farthest_along(b.X_WS.p - a.X_WS.p);
  nearest.offer({first}, first);
  for (int i = 0; i < kMostIterations; ++i) {
    if (nearest.square < kMeeting_m * kMeeting_m) return 0.0;
    const Vec3 next = farthest_along(-1.0 * nearest.point);
    if (nearest.square - dot(nearest.point, next) <= kRelativeError * nearest.square) break;
    Simplex& simplex = nearest.simplex;
    simplex.points[simplex.size++] = next;
    if (holds_origin(simplex)) return 0.0;
    const Nearest nearer = nearest_to_origin(simplex);
    if (!(nearer.square < nearest.square)) break;
    nearest = nearer;
  }
  return std::max(0.0, std::sqrt(nearest.square) - rounding);
}

}  // namespace tether::sim
