#pragma once

#include "place/lens.h"
#include "scene/prepared_scene.h"

#include <array>
#include <cstdint>

namespace tether::raster {

/// From V to C, and on to the picture.
struct Transformation {
  std::array<float, 9> rotation;  ///< row by row
  std::array<float, 3> translation;
  float fx, fy, cx, cy;  ///< in kSubpixels
  float near_m;
  FixedRect seen;  ///< no other part of the picture matters
};

/// Where a vertex is outside. Those with one of kUnusable cannot be taken as they are.
enum Outside : std::int32_t {
  kNear = 1,
  kLeft = 2,
  kRight = 4,
  kAbove = 8,
  kBelow = 16,
  kUnseen = 32,  ///< times kLeft, …: outside of what is seen
  kUnusable = kUnseen - 1,
};

/// A cluster's corners in C and in the picture.
struct PlacedVertices {
  alignas(64) std::array<float, Cluster::kMaxCorners> x, y, z;         ///< [m]
  alignas(64) std::array<std::int32_t, Cluster::kMaxCorners> u, v;     ///< in kSubpixels
  alignas(64) std::array<std::int32_t, Cluster::kMaxCorners> outside;  ///< of Outside
};

/// Places a cluster's corners. @returns which triangles may be seen, as bits: not those that are
/// outside of one side of what is seen, nor those that clearly show their back, unless
/// `both_sides`.
std::uint64_t place_vertices(const PreparedScene& scene, const Cluster& cluster,
                             const Transformation& t, bool both_sides, PlacedVertices& out);

}  // namespace tether::raster
