#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <tether/sim/world.h>
#include <tether/uav/math.h>

namespace tether::sim {

/// How a surface's texture is laid on it.
struct TextureScale {
  double repeat_x_per_m = 1.0;
  double repeat_y_per_m = 1.0;
};

/// Triangles ready to draw: metres, counter-clockwise seen from outside. Texture coordinates count
/// repetitions; v runs down the picture, as its rows do.
struct TriangleMesh {
  struct Vertex {
    std::array<float, 3> position{};
    std::array<float, 3> normal{};  ///< unit
    std::array<float, 2> uv{};
  };
  std::vector<Vertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into `vertices`
};

/// The sphere around a mesh: what culling needs.
struct BoundingSphere {
  uav::Vec3 centre;
  double radius_m = 0.0;
};
BoundingSphere bounding_sphere(const TriangleMesh& mesh);

/// Light is computed per vertex, so large faces are divided into pieces of at most this edge
/// length.
inline constexpr double kMaxEdge_m = 0.5;

/// Each face carries its texture upright (seen from outside, with z up), starting at its upper left
/// corner.
TriangleMesh box_mesh(const uav::Vec3& size_m, const TextureScale& scale);
/// The side unrolled around z; the caps flat.
TriangleMesh cylinder_mesh(double radius_m, double length_m, const TextureScale& scale);
TriangleMesh capsule_mesh(double radius_m, double length_m, const TextureScale& scale);
/// Also a sphere, with equal radii.
TriangleMesh ellipsoid_mesh(const uav::Vec3& radii_m, const TextureScale& scale);
/// One-sided: seen from where `normal` points.
TriangleMesh plane_mesh(const PlaneGeometry& plane, const TextureScale& scale);

/// The rotation that turns z to `normal` (need not be unit; zero is taken as z).
uav::Quat rotation_from_z(const uav::Vec3& normal);

}  // namespace tether::sim
