#include "meshes/mesh_file.h"

#include "test_simulator.h"

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/text_file.h>

namespace tether::sim {
namespace {

using testing::no_warnings;

MeshGeometry mesh_file(const std::string& name) {
  return {std::filesystem::path(TETHER_TEST_DIR) / "data" / name, "", {1.0, 1.0, 1.0}};
}

raster::Mesh load_mesh(const MeshGeometry& mesh) {
  return MeshFiles().load(mesh, {});
}

TEST(MeshFileTest, ReadsObjWithSubmeshAndScale) {
  MeshGeometry mesh = mesh_file("slab.obj");
  mesh.submesh = "slab";
  mesh.scale = {2.0, 1.0, 10.0};
  const raster::Mesh slab = load_mesh(mesh);
  EXPECT_EQ(slab.triangles.size(), 12U);
  for (const raster::Mesh::Vertex& v : slab.vertices) {
    EXPECT_NEAR(std::abs(v.position[0]), 2.0, 1e-6);
    EXPECT_NEAR(std::abs(v.position[1]), 0.5, 1e-6);
    EXPECT_NEAR(std::abs(v.position[2]), 1.0, 1e-6);
  }
}

TEST(MeshFileTest, CentersASubmesh) {
  MeshGeometry mesh = mesh_file("triangle.dae");
  mesh.is_centered = true;
  const raster::Mesh triangle = load_mesh(mesh);
  const auto& apex = triangle.vertices[triangle.triangles[0][2]].position;
  EXPECT_NEAR(apex[0], -0.5, 1e-5);
  EXPECT_NEAR(apex[1], 0.0, 1e-5);
  EXPECT_NEAR(apex[2], 1.0, 1e-5);
}

TEST(MeshFileTest, KeepsTextureCoordinatesWithVDown) {
  MeshGeometry mesh = mesh_file("slab.obj");
  mesh.submesh = "card";
  for (const raster::Mesh::Vertex& v : load_mesh(mesh).vertices) {
    EXPECT_NEAR(v.uv[0], v.position[1], 1e-6);
    EXPECT_NEAR(v.uv[1], 1.0F - v.position[2], 1e-6);
  }
}

// Many programs write STL without normals.
TEST(MeshFileTest, ATriangleWhoseNormalHasNoDirectionGetsItsOwn) {
  const ScratchFolder scratch;
  for (const char* const normal : {"0 0 0", "nan 0 0", "inf 0 0"}) {
    const std::string facet = std::string("solid a\n facet normal ") + normal +
                              "\n  outer loop\n   vertex 0 0 0\n   vertex 0 1 0\n   vertex 0 0 1\n"
                              "  endloop\n endfacet\nendsolid a\n";
    const auto file = scratch.write("a.stl", facet);
    for (const raster::Mesh::Vertex& v : load_mesh({file, "", {1.0, 1.0, 1.0}}).vertices) {
      EXPECT_EQ(v.normal, (std::array{1.0F, 0.0F, 0.0F})) << normal;
    }
  }
}

TEST(MeshFileTest, MirroringKeepsTheOutsideOut) {
  MeshGeometry mesh = mesh_file("tetra.stl");
  mesh.scale = {-1.0, 1.0, 1.0};
  const raster::Mesh out = load_mesh(mesh);
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
  const raster::Mesh mesh = load_mesh(mesh_file("triangle.dae"));
  ASSERT_EQ(mesh.triangles.size(), 1U);
  const auto& apex = mesh.vertices[mesh.triangles[0][2]].position;
  EXPECT_NEAR(apex[0], 0.0, 1e-5);
  EXPECT_NEAR(apex[1], 3.0, 1e-5);
  EXPECT_NEAR(apex[2], 2.0, 1e-5);
}

// As 3ds Max writes it: the name of the node is not its id, and an image has no file.
TEST(MeshFileTest, ColladaGoesByNamesOfNodesAndNeedsNoPictures) {
  std::string text = os::read_file(mesh_file("triangle.dae").file);
  const auto put = [&](const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  put("<node id=\"node\" name=\"node\">", "<node id=\"node-Body\" name=\"Body\"><node>");
  put("<instance_geometry url=\"#tri\"/>",
      "<instance_geometry url='#tri'><bind_material><technique_common>"
      "<instance_material symbol='m' target='#material'/></technique_common></bind_material>"
      "</instance_geometry></node>");
  put("<triangles", "<triangles material='m'");
  put("<library_visual_scenes>",
      "<library_images><image id='picture'/></library_images><library_effects><effect id='effect'>"
      "<profile_COMMON><technique sid='t'><phong><diffuse><texture texture='picture'/></diffuse>"
      "</phong></technique></profile_COMMON></effect></library_effects><library_materials>"
      "<material id='material'><instance_effect url='#effect'/></material></library_materials>"
      "<library_visual_scenes>");
  const ScratchFolder scratch;
  const MeshGeometry mesh{scratch.write("max.dae", text), "Body", {1.0, 1.0, 1.0}};
  EXPECT_EQ(load_mesh(mesh).triangles.size(), 1U);
}

TEST(MeshFileTest, RefusesAnUnknownSubmeshAndAnUnreadableFile) {
  MeshGeometry mesh = mesh_file("slab.obj");
  mesh.submesh = "lid";
  const Error error = bad_file_error([&] { load_mesh(mesh); });
  EXPECT_EQ(error.where().file, mesh.file.string());
  EXPECT_EQ(error.subject(), "lid");
  const MeshGeometry text = mesh_file("../mesh_file_test.cpp");
  EXPECT_EQ(bad_file_error([&] { load_mesh(text); }).where().file, text.file.string());
}

std::string polygon_obj(int corners) {
  std::string vertices;
  std::string face = "f";
  for (int i = 0; i < corners; ++i) {
    vertices += "v " + std::to_string(std::cos(6.28 * i / corners)) + ' ' +
                std::to_string(std::sin(6.28 * i / corners)) + " 0\n";
    face += ' ' + std::to_string(i + 1);
  }
  return vertices + face + '\n';
}

std::string collada(const std::string& nodes, const std::string& library = "") {
  return "<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'>"
         "<library_nodes>" +
         library +
         "</library_nodes><library_visual_scenes>"
         "<visual_scene id='s'>" +
         nodes +
         "</visual_scene></library_visual_scenes>"
         "<scene><instance_visual_scene url='#s'/></scene></COLLADA>";
}

std::string repeated(const std::string& text, int times) {
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

// Each has made Assimp crash, or would keep it busy for hours, or leave it with numbers of no use.
TEST(MeshFileTest, RefusesWhatCannotBeDrawn) {
  const std::vector<std::pair<std::string, std::string>> bad{
      {"none.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n"},
      {"nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"far.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"polygon.obj", polygon_obj(1001)},
      {"empty.stl", ""},
      {"short.stl", std::string(80, ' ') + std::string(4, '\xff')},
      {"other.obj", "ply\nformat ascii 1.0\nelement vertex 1\nend_header\n0 0 0\n"},
      {"circle.dae", collada("<node id='a'><instance_node url='#a'/></node>")},
      {"deep.dae", collada(repeated("<node>", 5000) + repeated("</node>", 5000))},
      {"many.dae", collada(repeated("<node/>", 100'001))},
      {"archive.dae", "PK\x03\x04 not XML"},
      {"none.dae", collada("")},
  };
  const ScratchFolder scratch;
  for (const auto& [name, text] : bad) {
    const MeshGeometry mesh{scratch.write(name, text), "", {1.0, 1.0, 1.0}};
    EXPECT_EQ(bad_file_error([&] { load_mesh(mesh); }).where().file, mesh.file.string()) << name;
  }
}

TEST(MeshFileTest, OpensNoOtherFile) {
  const ScratchFolder scratch;
  std::filesystem::path pipe = scratch.path("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);  // reading it never ends
  const auto file = scratch.write("a.obj", "mtllib pipe\n" + polygon_obj(3));
  EXPECT_EQ(load_mesh({file, "", {1.0, 1.0, 1.0}}).triangles.size(), 1U);
}

TEST(MeshFileTest, GivesNormalsWhereTheFileHasNone) {
  const ScratchFolder scratch;
  const auto file = scratch.write("a.obj", polygon_obj(1000));
  const raster::Mesh mesh = load_mesh({file, "", {1.0, 1.0, 1.0}});
  EXPECT_EQ(mesh.triangles.size(), 998U);
  for (const raster::Mesh::Vertex& v : mesh.vertices) EXPECT_NEAR(v.normal[2], 1.0F, 1e-6);
}

// 150 collisions of one mesh: the file is not read again.
TEST(MeshFileTest, ReadsAFileOnce) {
  const ScratchFolder scratch;
  const MeshFiles files;
  MeshGeometry mesh{scratch.write("a.obj", polygon_obj(8)), "", {1.0, 1.0, 1.0}};
  EXPECT_EQ(files.corners(mesh).size(), 16U) << "flat: two places around each";
  std::filesystem::remove(mesh.file);
  mesh.scale = {2.0, 1.0, 1.0};
  EXPECT_EQ(files.load(mesh, {}).triangles.size(), 6U);
}

}  // namespace
}  // namespace tether::sim
