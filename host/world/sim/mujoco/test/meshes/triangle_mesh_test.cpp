#include "meshes/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using uav::Vec3;

Vec3 position(const raster::Mesh& mesh, std::uint32_t i) {
  const auto [x, y, z] = mesh.vertices[i].position;
  return {x, y, z};
}

// By the divergence theorem; positive only if the triangles look outwards.
double volume_m3(const raster::Mesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += dot(position(mesh, a), cross(position(mesh, b), position(mesh, c))) / 6.0;
  }
  return sum;
}

// The least cosine between a vertex normal and the normal of a triangle there.
double worst_normal(const raster::Mesh& mesh) {
  double worst = 1.0;
  for (const auto& triangle : mesh.triangles) {
    const auto& [a, b, c] = triangle;
    const Vec3 n =
        cross(position(mesh, b) - position(mesh, a), position(mesh, c) - position(mesh, a));
    if (norm(n) < 1e-9) continue;  // at a pole
    for (const std::uint32_t i : triangle) {
      const auto [x, y, z] = mesh.vertices[i].normal;
      worst = std::min(worst, dot((1.0 / norm(n)) * n, {x, y, z}));
    }
  }
  return worst;
}

struct Case {
  std::string name;
  raster::Mesh mesh;
  double volume_m3;
  double tolerance;
};

TEST(TriangleMeshTest, ClosedShapesHaveTheirVolumeAndLookOutwards) {
  const double pi = std::numbers::pi;
  const Case cases[] = {
      {"box", box_mesh({1.0, 2.0, 0.5}, {}), 1.0, 1e-6},
      {"cylinder", cylinder_mesh(0.5, 2.0, {}), pi * 0.25 * 2.0, 0.02},
      {"capsule", capsule_mesh(0.5, 1.0, {}), pi * (0.25 + 4.0 / 3.0 * 0.125), 0.03},
      {"ellipsoid", ellipsoid_mesh({1.0, 0.5, 0.25}, {}), 4.0 / 3.0 * pi * 0.125, 0.03},
  };
  for (const Case& c : cases) {
    EXPECT_NEAR(volume_m3(c.mesh), c.volume_m3, c.tolerance * c.volume_m3) << c.name;
    EXPECT_GT(worst_normal(c.mesh), 0.8) << c.name;
  }
}

TEST(TriangleMeshTest, TextureCountsRepetitionsPerMetreAndStartsAtTheUpperLeft) {
  const raster::Mesh mesh = box_mesh({0.1, 4.0, 2.0}, {0.5, 2.0});
  for (const raster::Mesh::Vertex& v : mesh.vertices) {
    if (v.normal[0] < 0.5F) continue;  // the face that looks along +x; its left is −y
    EXPECT_NEAR(v.uv[0], (v.position[1] + 2.0) * 0.5, 1e-5);
    EXPECT_NEAR(v.uv[1], (1.0 - v.position[2]) * 2.0, 1e-5);
  }
}

// Corners of the picture, by where Gazebo has them.
TEST(TriangleMeshTest, OnceOnEachFaceAsGazeboHasIt) {
  const TextureScale once{1.0, 1.0, TextureRepeat::kPerFace};
  for (const raster::Mesh::Vertex& v : box_mesh({2.0, 4.0, 6.0}, once).vertices) {
    const float x = v.position[0] / 2.0F, y = v.position[1] / 4.0F, z = v.position[2] / 6.0F;
    if (v.normal[0] > 0.5F) {
      EXPECT_NEAR(v.uv[0], 0.5F + y, 1e-6);
      EXPECT_NEAR(v.uv[1], 0.5F - z, 1e-6);
    } else if (v.normal[2] > 0.5F) {
      EXPECT_NEAR(v.uv[0], 0.5F - y, 1e-6);
      EXPECT_NEAR(v.uv[1], 0.5F - x, 1e-6);
    }
  }
  const TextureScale twice{2.0, 1.0, TextureRepeat::kPerFace};
  for (const raster::Mesh::Vertex& v : plane_mesh({{0.0, 0.0, 1.0}, 4.0, 10.0}, twice).vertices) {
    EXPECT_NEAR(v.uv[0], 0.5F + 2.0F * v.position[0] / 4.0F, 1e-6);  // from the middle
    EXPECT_NEAR(v.uv[1], 0.5F - v.position[1] / 10.0F, 1e-6);
  }
  for (const raster::Mesh& mesh : {cylinder_mesh(0.5, 4.0, once), capsule_mesh(0.5, 1.0, once),
                                   ellipsoid_mesh({1.0, 2.0, 3.0}, once)}) {
    for (std::size_t i = 0; i < 2; ++i) {
      const auto at = [i](const raster::Mesh::Vertex& v) { return v.uv[i]; };
      EXPECT_NEAR(std::ranges::min(mesh.vertices, {}, at).uv[i], 0.0F, 1e-5);
      EXPECT_NEAR(std::ranges::max(mesh.vertices, {}, at).uv[i], 1.0F, 1e-5);
    }
  }
}

TEST(TriangleMeshTest, TheInsideIsTheOutsideTurned) {
  raster::Mesh mesh = box_mesh({1.0, 1.0, 1.0}, {});
  const std::size_t triangles = mesh.triangles.size();
  add_inside(mesh);
  EXPECT_EQ(mesh.triangles.size(), 2 * triangles);
  EXPECT_NEAR(volume_m3(mesh), 0.0, 1e-6);
  EXPECT_GT(worst_normal(mesh), 0.99);
}

TEST(TriangleMeshTest, PlaneLooksAlongItsNormal) {
  for (const Vec3& normal : {Vec3{0.0, 0.0, 1.0}, Vec3{0.0, 0.0, -1.0}, Vec3{1.0, 2.0, 0.5}}) {
    const raster::Mesh mesh = plane_mesh({normal, 2.0, 1.0}, {});
    const auto [x, y, z] = mesh.vertices.front().normal;
    EXPECT_NEAR(dot(normal, {x, y, z}), norm(normal), 1e-6);
    EXPECT_GT(worst_normal(mesh), 0.999);
  }
}

}  // namespace
}  // namespace tether::sim
