#pragma once

#include "place/layer.h"

#include <array>
#include <cstddef>
#include <cstdint>

#include <tether/uav/math.h>

namespace tether::raster {

struct FixedPoint {
  std::int32_t x, y;  ///< in kSubpixels
};

/// A convex polygon in C with its place in the picture.
struct Polygon {
  struct Point {
    uav::Vec3 p_C;
    FixedPoint fixed;
    bool is_placed;  ///< whether `fixed` is known
  };
  /// Of a triangle, five planes leave eight points at most; rounding may make one more of two.
  std::array<Point, 12> points;
  std::size_t size = 0;

  void add(const Point& point) {
    if (size < points.size()) points[size++] = point;
  }
};

/// Cuts a polygon at the near plane and at kGuard, and places its new points. Two polygons that
/// share an edge get the same points on it. Fewer than 3 points are left of a polygon outside.
void clip(Polygon& polygon, const Projection& projection);

}  // namespace tether::raster
