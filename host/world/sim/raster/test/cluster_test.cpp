#include "scene/prepared_scene.h"
#include "test_scenes.h"

#include <gtest/gtest.h>

namespace tether::raster {
namespace {

TEST(Cluster, HoldsEachTriangleOnceWithItsCorners) {
  PreparedScene scene;
  const Mesh mesh = ball(1.0F, 30);
  const PreparedMesh prepared = add_mesh(mesh, scene);
  EXPECT_EQ(prepared.triangles, 2U * 30 * 30 - 30) << "those at one pole have no area at all";
  std::uint32_t triangles = 0;
  for (const Cluster& c : scene.clusters) {
    EXPECT_LE(c.triangles, Cluster::kMaxTriangles);
    EXPECT_EQ(c.first_triangle, triangles);
    triangles += c.triangles;
    for (std::uint32_t i = 0; i < c.triangles; ++i) {
      for (std::uint32_t corner = 0; corner < 3; ++corner) {
        const std::size_t at = c.first_corner + corner * c.stride + i;
        const auto& vertex = mesh.vertices[scene.triangles[c.first_triangle + i][corner]];
        EXPECT_EQ((std::array{scene.x[at], scene.y[at], scene.z[at]}), vertex.position);
        const uav::Vec3 p{scene.x[at], scene.y[at], scene.z[at]};
        EXPECT_LE(norm(p - c.bounds.centre), c.bounds.radius_m * (1.0 + 1e-6));
      }
    }
  }
  EXPECT_EQ(triangles, prepared.triangles);
}

}  // namespace
}  // namespace tether::raster
