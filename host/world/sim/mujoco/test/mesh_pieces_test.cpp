#include "mesh_pieces.h"

#include "triangle_mesh.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace tether::sim {
namespace {

raster::Mesh boxes_at(const std::vector<float>& places) {
  raster::Mesh all;
  for (const float x : places) {
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    const raster::Mesh box = box_mesh({1.0, 1.0, 1.0}, {});
    for (raster::Mesh::Vertex v : box.vertices) {
      v.position[0] += x;
      all.vertices.push_back(v);
    }
    for (const auto& [a, b, c] : box.triangles)
      all.triangles.push_back({first + a, first + b, first + c});
  }
  return all;
}

TEST(MeshPieces, AreConnectedByEdgesOfTwoTriangles) {
  EXPECT_EQ(connected_pieces(boxes_at({0.0F})).size(), 1U);
  const auto apart = connected_pieces(boxes_at({5.0F, 0.0F}));
  ASSERT_EQ(apart.size(), 2U);
  EXPECT_EQ(apart[0].size(), 8U);
  EXPECT_EQ(apart[0].front().x, -0.5) << "in the order of x";
  EXPECT_EQ(apart[1].back().x, 5.5);
}

// Of two walls that touch in a corner, each has its own hull.
TEST(MeshPieces, OfTouchingBoxesAreEachABox) {
  raster::Mesh mesh = boxes_at({0.0F, 1.0F});
  for (std::size_t i = mesh.vertices.size() / 2; i < mesh.vertices.size(); ++i)
    mesh.vertices[i].position[1] += 1.0F;
  EXPECT_EQ(connected_pieces(mesh).size(), 2U);
}

TEST(MeshPieces, FlatOnesGetAThickness) {
  const std::vector<uav::Vec3> flat{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  const auto thick = with_volume(flat);
  EXPECT_EQ(thick.size(), 24U);
  const auto [low, high] = std::ranges::minmax(thick, {}, &uav::Vec3::z);
  EXPECT_NEAR(high.z - low.z, 0.002, 1e-9);
  const std::vector<uav::Vec3> solid{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_EQ(with_volume(solid), solid);
}

}  // namespace
}  // namespace tether::sim
