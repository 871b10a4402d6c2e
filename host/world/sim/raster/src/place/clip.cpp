#include "place/clip.h"

#include <algorithm>
#include <cmath>

namespace tether::raster {
namespace {

using uav::Vec3;

// How far inside of a plane: n·p + c.
struct Plane {
  Vec3 n;
  double c;
  double at(const Vec3& p) const { return dot(n, p) + c; }
};

// The planes through the camera's centre at kGuard, and the near one.
std::array<Plane, 5> planes(const Projection& p) {
  const double guard = static_cast<double>(kGuard) / kSubpixels;
  return {Plane{{0.0, 0.0, 1.0}, -p.near_m}, Plane{{p.fx, 0.0, p.cx + guard}, 0.0},
          Plane{{-p.fx, 0.0, guard - p.cx}, 0.0}, Plane{{0.0, p.fy, p.cy + guard}, 0.0},
          Plane{{0.0, -p.fy, guard - p.cy}, 0.0}};
}

// From the inner to the outer end, so that both of its triangles cut an edge at one point.
Polygon::Point cut(const Polygon::Point& inner, const Polygon::Point& outer, const Plane& plane) {
  const double inside = plane.at(inner.p_C);
  const double share = inside / (inside - plane.at(outer.p_C));
  return {inner.p_C + share * (outer.p_C - inner.p_C), {0, 0}, false};
}

bool is_cut(const Polygon& polygon, const Plane& plane) {
  const auto* const begin = polygon.points.data();
  return std::any_of(begin, begin + polygon.size,
                     [&](const Polygon::Point& point) { return plane.at(point.p_C) < 0.0; });
}

// What is inside of a plane.
void cut(const Polygon& polygon, const Plane& plane, Polygon& kept) {
  kept.size = 0;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Polygon::Point& here = polygon.points[i];
    const Polygon::Point& next = polygon.points[i + 1 == polygon.size ? 0 : i + 1];
    const bool is_inside = plane.at(here.p_C) >= 0.0;
    if (is_inside) kept.add(here);
    if (is_inside != (plane.at(next.p_C) >= 0.0)) {
      kept.add(is_inside ? cut(here, next, plane) : cut(next, here, plane));
    }
  }
}

std::int32_t fixed(double px) {
  const double guard = kGuard;
  return static_cast<std::int32_t>(std::floor(std::clamp(px * kSubpixels, -guard, guard) + 0.5));
}

}  // namespace

void clip(Polygon& polygon, const Projection& projection) {
  Polygon other;
  Polygon* whole = &polygon;
  Polygon* kept = &other;
  for (const Plane& plane : planes(projection)) {
    if (!is_cut(*whole, plane)) continue;
    cut(*whole, plane, *kept);
    std::swap(whole, kept);
  }
  if (whole == &other) polygon = other;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    Polygon::Point& point = polygon.points[i];
    if (point.is_placed) continue;
    const Vec3& p = point.p_C;
    const double z = std::max(p.z, projection.near_m);
    point.fixed = {fixed(projection.fx * p.x / z + projection.cx),
                   fixed(projection.fy * p.y / z + projection.cy)};
  }
}

}  // namespace tether::raster
