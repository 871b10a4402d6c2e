#include "mesh_file.h"

#include "test_simulator.h"

#include <filesystem>

#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::sim {
namespace {

using testing::no_warnings;

MeshGeometry mesh_file(const std::string& name) {
  return {std::filesystem::path(TETHER_TEST_DIR) / "data" / name, "", {1.0, 1.0, 1.0}};
}

TEST(MeshFileTest, ReadsObjWithSubmeshAndScale) {
  MeshGeometry mesh = mesh_file("slab.obj");
  mesh.submesh = "slab";
  mesh.scale = {2.0, 1.0, 10.0};
  const raster::Mesh slab = load_mesh(mesh, {}, no_warnings());
  EXPECT_EQ(slab.triangles.size(), 12U);
  for (const raster::Mesh::Vertex& v : slab.vertices) {
    EXPECT_NEAR(std::abs(v.position[0]), 2.0, 1e-6);
    EXPECT_NEAR(std::abs(v.position[1]), 0.5, 1e-6);
    EXPECT_NEAR(std::abs(v.position[2]), 1.0, 1e-6);
  }
}

TEST(MeshFileTest, KeepsTextureCoordinatesWithVDown) {
  MeshGeometry mesh = mesh_file("slab.obj");
  mesh.submesh = "card";
  for (const raster::Mesh::Vertex& v : load_mesh(mesh, {}, no_warnings()).vertices) {
    EXPECT_NEAR(v.uv[0], v.position[1], 1e-6);
    EXPECT_NEAR(v.uv[1], 1.0F - v.position[2], 1e-6);
  }
}

TEST(MeshFileTest, MirroringKeepsTheOutsideOut) {
  MeshGeometry mesh = mesh_file("tetra.stl");
  mesh.scale = {-1.0, 1.0, 1.0};
  const raster::Mesh out = load_mesh(mesh, {}, no_warnings());
  double volume = 0.0;
  for (const auto& [a, b, c] : out.triangles) {
    const auto at = [&](std::uint32_t i) {
      const auto [x, y, z] = out.vertices[i].position;
      return uav::Vec3{x, y, z};
    };
    volume += dot(at(a), cross(at(b), at(c))) / 6.0;
  }
  EXPECT_NEAR(volume, 1.0 / 6.0, 1e-6);
}

TEST(MeshFileTest, ColladaUnitsAndNodesButNotItsUpAxis) {
  const raster::Mesh mesh = load_mesh(mesh_file("triangle.dae"), {}, no_warnings());
  ASSERT_EQ(mesh.triangles.size(), 1U);
  const auto& apex = mesh.vertices[mesh.triangles[0][2]].position;
  EXPECT_NEAR(apex[0], 0.0, 1e-5);
  EXPECT_NEAR(apex[1], 3.0, 1e-5);
  EXPECT_NEAR(apex[2], 2.0, 1e-5);
}

TEST(MeshFileTest, RefusesAnUnknownSubmeshAndAnUnreadableFile) {
  MeshGeometry mesh = mesh_file("slab.obj");
  mesh.submesh = "lid";
  const Error error = bad_file_error([&] { load_mesh(mesh, {}, no_warnings()); });
  EXPECT_EQ(error.where().file, mesh.file.string());
  EXPECT_EQ(error.subject(), "lid");
  const MeshGeometry text = mesh_file("../mesh_file_test.cpp");
  EXPECT_EQ(bad_file_error([&] { load_mesh(text, {}, no_warnings()); }).where().file,
            text.file.string());
}

}  // namespace
}  // namespace tether::sim
