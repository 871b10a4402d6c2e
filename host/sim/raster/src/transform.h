#pragma once

#include "lens.h"
#include "prepared_scene.h"

#include <array>
#include <cstdint>

namespace tether::raster {

/// From V to C, and on to the picture.
struct Transformation {
  std::array<float, 9> rotation;  ///< row by row
  std::array<float, 3> translation;
  float fx, fy, cx, cy;  ///< in kSubpixels
  float near_m;
};

/// Why a vertex cannot be taken as it is.
enum Outside : std::int32_t {
  kNear = 1,
  kLeft = 2,
  kRight = 4,
  kAbove = 8,
  kBelow = 16,
};

/// A cluster's corners in C and in the picture.
struct PlacedVertices {
  alignas(64) std::array<float, Cluster::kMaxCorners> x, y, z;         ///< [m]
  alignas(64) std::array<std::int32_t, Cluster::kMaxCorners> u, v;     ///< in kSubpixels
  alignas(64) std::array<std::int32_t, Cluster::kMaxCorners> outside;  ///< of Outside
};

void place_vertices(const PreparedScene& scene, const Cluster& cluster, const Transformation& t,
                    PlacedVertices& out);

}  // namespace tether::raster
