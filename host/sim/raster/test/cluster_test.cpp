#include "prepared_scene.h"
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
    EXPECT_LE(c.vertices, Cluster::kMaxVertices);
    EXPECT_EQ(c.first_vertex % kMaxLanes, 0U);
    EXPECT_EQ(c.first_triangle, triangles);
    triangles += c.triangles;
    for (std::uint32_t i = 0; i < c.vertices; ++i) {
      const std::size_t v = c.first_vertex + i;
      const uav::Vec3 p{scene.x[v], scene.y[v], scene.z[v]};
      EXPECT_LE(norm(p - c.bounds.centre), c.bounds.radius_m * (1.0 + 1e-6));
    }
  }
  EXPECT_EQ(triangles, prepared.triangles);
}

}  // namespace
}  // namespace tether::raster
