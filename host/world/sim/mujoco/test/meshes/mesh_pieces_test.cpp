#include "meshes/mesh_pieces.h"

#include "meshes/triangle_mesh.h"

#include <algorithm>
#include <cmath>
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

TEST(MeshPieces, AreTheSolidPartsThatAreConvex) {
  EXPECT_EQ(collision_pieces(boxes_at({0.0F})).corners.size(), 1U);
  const auto apart = collision_pieces(boxes_at({5.0F, 0.0F})).corners;
  ASSERT_EQ(apart.size(), 2U);
  const auto lowest_m = [](const auto& corners) {
    return std::ranges::min(corners, {}, &uav::Vec3::x).x;
  };
  EXPECT_EQ(lowest_m(apart[0]), 4.5);
  EXPECT_EQ(lowest_m(apart[1]), -0.5);
}

// Of two walls that touch in a corner, each has its own hull.
TEST(MeshPieces, OfTouchingBoxesAreEachABox) {
  raster::Mesh mesh = boxes_at({0.0F, 1.0F});
  for (std::size_t i = mesh.vertices.size() / 2; i < mesh.vertices.size(); ++i)
    mesh.vertices[i].position[1] += 1.0F;
  EXPECT_EQ(collision_pieces(mesh).corners.size(), 2U);
}

raster::Mesh inside_out(raster::Mesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  return mesh;
}

TEST(MeshPieces, OfARoomAreItsWalls) {
  const CollisionPieces room = collision_pieces(inside_out(boxes_at({0.0F})));
  EXPECT_EQ(room.corners.size(), 6U);
  EXPECT_EQ(room.tolerance_m, 0.01);
}

TEST(MeshPieces, OfARoomWithThickWallsAreTheirInnerAndOuterSides) {
  raster::Mesh mesh = inside_out(boxes_at({0.0F}));
  const auto inner = static_cast<std::uint32_t>(mesh.vertices.size());
  for (raster::Mesh::Vertex v : boxes_at({0.0F}).vertices) {
    for (float& x : v.position) x *= 1.2F;
    mesh.vertices.push_back(v);
  }
  for (const auto& [a, b, c] : boxes_at({0.0F}).triangles)
    mesh.triangles.push_back({inner + a, inner + b, inner + c});
  EXPECT_EQ(collision_pieces(mesh).corners.size(), 12U);
}

TEST(MeshPieces, OfABoxAreABoxInWhateverAttitude) {
  const uav::Vec3 size_m{0.5, 4.0, 2.0}, middle{3.0, -1.0, 7.0};
  for (const auto& q :
       {uav::Quat{}, uav::from_rpy(0.3, -0.7, 2.9), uav::from_rpy(3.1, 0.0, -1.6)}) {
    std::vector<uav::Vec3> corners;
    for (int i = 0; i < 8; ++i)
      corners.push_back(middle + rotate(q, {((i & 1) != 0 ? 0.5 : -0.5) * size_m.x,
                                            ((i & 2) != 0 ? 0.5 : -0.5) * size_m.y,
                                            ((i & 4) != 0 ? 0.5 : -0.5) * size_m.z}));
    const auto box = as_box(corners);
    ASSERT_TRUE(box);
    EXPECT_NEAR(norm(box->X_MB.p - middle), 0.0, 1e-9);
    for (const uav::Vec3& p : corners) {
      const uav::Vec3 in_box = rotate(inverse(box->X_MB.q), p - middle);
      EXPECT_NEAR(std::abs(in_box.x), 0.5 * box->size_m.x, 1e-9);
      EXPECT_NEAR(std::abs(in_box.y), 0.5 * box->size_m.y, 1e-9);
      EXPECT_NEAR(std::abs(in_box.z), 0.5 * box->size_m.z, 1e-9);
    }
    corners.back().x += 0.1;
    EXPECT_FALSE(as_box(corners)) << "skewed";
    corners.pop_back();
    EXPECT_FALSE(as_box(corners)) << "without a corner";
  }
}

TEST(MeshPieces, FlatOnesGetAThickness) {
  const std::vector<uav::Vec3> flat{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  const auto thick = with_volume(flat);
  EXPECT_EQ(thick.size(), 6U);
  const auto [low, high] = std::ranges::minmax(thick, {}, &uav::Vec3::z);
  EXPECT_NEAR(high.z - low.z, 0.002, 1e-9);
  const std::vector<uav::Vec3> line{{0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(with_volume(line).size(), 16U);
  const std::vector<uav::Vec3> solid{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_EQ(with_volume(solid), solid);
}

}  // namespace
}  // namespace tether::sim
