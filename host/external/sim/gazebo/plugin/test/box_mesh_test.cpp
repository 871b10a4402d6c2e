#include <gtest/gtest.h>

#include <tether/sim_gazebo_plugin/shape_rays.h>

namespace tether::gazebo_plugin {
namespace {

using uav::Vec3;

class TexturedBox : public ::testing::Test {
 protected:
  BoxMesh mesh = textured_box({2.0, 3.0, 4.0}, 0.5, 0.25);

  // Of the face that looks along `normal`, the vertex with these texture coordinates.
  Vec3 at(const Vec3& normal, double u, double v) const {
    for (const BoxVertex& vertex : mesh.vertices) {
      if (vertex.normal == normal && vertex.u == u && vertex.v == v) return vertex.position;
    }
    ADD_FAILURE() << "no vertex with " << u << ", " << v;
    return {};
  }
};

TEST_F(TexturedBox, BeginsTheTextureInTheUpperLeftCornerSeenFromOutside) {
  EXPECT_EQ(at({1, 0, 0}, 0, 0), (Vec3{0.5, -0.5, 0.5}));
  EXPECT_EQ(at({-1, 0, 0}, 0, 0), (Vec3{-0.5, 0.5, 0.5}));
  EXPECT_EQ(at({0, 1, 0}, 0, 0), (Vec3{0.5, 0.5, 0.5}));
  EXPECT_EQ(at({0, -1, 0}, 0, 0), (Vec3{-0.5, -0.5, 0.5}));
  EXPECT_EQ(at({0, 0, 1}, 0, 0), (Vec3{-0.5, 0.5, 0.5}));
  EXPECT_EQ(at({0, 0, -1}, 0, 0), (Vec3{0.5, 0.5, -0.5}));
}

TEST_F(TexturedBox, RepeatsTheTexturePerMetreOfEachFace) {
  EXPECT_EQ(at({1, 0, 0}, 3 * 0.5, 4 * 0.25), (Vec3{0.5, 0.5, -0.5}));
  EXPECT_EQ(at({0, 1, 0}, 2 * 0.5, 4 * 0.25), (Vec3{-0.5, 0.5, -0.5}));
  EXPECT_EQ(at({0, 0, 1}, 2 * 0.5, 3 * 0.25), (Vec3{0.5, -0.5, 0.5}));
}

TEST_F(TexturedBox, TurnsEveryTriangleOutwards) {
  ASSERT_EQ(mesh.triangles.size(), 12U);
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3& p = mesh.vertices[a].position;
    const Vec3 out = cross(mesh.vertices[b].position - p, mesh.vertices[c].position - p);
    EXPECT_EQ(out, mesh.vertices[a].normal);
  }
}

}  // namespace
}  // namespace tether::gazebo_plugin
