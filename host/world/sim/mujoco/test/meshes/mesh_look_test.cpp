#include "meshes/mesh_look.h"

#include "meshes/mesh_file.h"

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/os/text_file.h>

namespace tether::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using uav::Vec3;

struct Loaded {
  std::vector<MeshPart> parts;
  std::vector<std::string> warnings;
};

Loaded load(const std::filesystem::path& file,
            const std::vector<std::filesystem::path>& companions = {}) {
  Loaded loaded;
  MeshGeometry mesh{file, "", {1.0, 1.0, 1.0}};
  mesh.companions = companions;
  loaded.parts = MeshFiles().parts(
      mesh, [&](const Warning& warning) { loaded.warnings.push_back(to_line(warning)); });
  return loaded;
}

std::string picture() {
  return os::read_file(std::filesystem::path(TETHER_TEST_DIR) / "data/quarters.png");
}

constexpr const char* kTwoColours =
    "mtllib paints.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n"
    "usemtl red\nf 1/1 2/2 3/3\nusemtl glass\nf 1/1 2/2 4/3\n";

TEST(MeshLookTest, PartsOfAnObjFileHaveTheColoursOfItsLibrary) {
  const ScratchFolder folder;
  const auto library = folder.write("paints.mtl",
                                    "newmtl red\nKa 0.5 0 0\nKd 1 0 0\nKs 0.25 0.25 0.25\n"
                                    "newmtl glass\nKd 0 0 1\nd 0.5\n");
  const auto mesh = folder.write("a.obj", kTwoColours);
  const Loaded loaded = load(mesh, {library});
  ASSERT_EQ(loaded.parts.size(), 2U);
  const Material& red = loaded.parts[0].look.material;
  EXPECT_EQ(red.diffuse_rgb, (Vec3{1.0, 0.0, 0.0}));
  EXPECT_EQ(red.ambient_rgb, (Vec3{0.5, 0.0, 0.0}));
  EXPECT_EQ(red.specular_rgb, (Vec3{0.25, 0.25, 0.25}));
  const Material& glass = loaded.parts[1].look.material;
  EXPECT_EQ(glass.diffuse_rgb, (Vec3{0.0, 0.0, 1.0}));
  EXPECT_EQ(glass.ambient_rgb, (Vec3{0.0, 0.0, 0.0}));  // as Gazebo takes it
  EXPECT_EQ(glass.alpha, 0.5);
  EXPECT_EQ(loaded.parts[1].mesh.triangles.size(), 1U);
  EXPECT_THAT(loaded.warnings, IsEmpty());
}

// Each has made Assimp crash.
TEST(MeshLookTest, TakesOfALibraryOnlyWhatItKnows) {
  EXPECT_EQ(clean_library("Kd 1 0 0\nnewmtl\nnewmtl a b\nKd 2 x\nKd 1 0.5 nan\nKd 1 0.5 0 7\n"
                          "map_Kd\nmap_Kd -s 1 1 1 a.png \r\nmap_Kd my wall.png\nd 0.5\nillum 2"),
            "newmtl a\nKd 1.000000 0.500000 0.000000\nmap_Kd a.png\nmap_Kd my wall.png\n"
            "d 0.500000\n");
  const ScratchFolder folder;
  const auto library = folder.write("paints.mtl", "\xcbnewmtl red\nKd 1 0 0\nd 0.5\n");
  EXPECT_EQ(load(folder.write("a.obj", kTwoColours), {library}).parts.size(), 2U);
}

TEST(MeshLookTest, WithoutItsLibraryAnObjFileIsGrey) {
  const ScratchFolder folder;
  folder.write("paints.mtl", "newmtl red\nKd 1 0 0\n");
  const Loaded loaded = load(folder.write("a.obj", kTwoColours));
  for (const MeshPart& part : loaded.parts)
    EXPECT_EQ(part.look.material.diffuse_rgb.x, part.look.material.diffuse_rgb.y);
}

TEST(MeshLookTest, PicturesAreFoundByTheirFileNameAndAreTinted) {
  const ScratchFolder folder;
  const auto png = folder.write("Two Walls.PNG", picture());
  const auto library = folder.write(
      "paints.mtl",
      "newmtl red\nKd 0.2 0 0\nmap_Kd C:\\pictures\\two walls.png\nnewmtl glass\nKd 0 0 1\n"
      "map_Kd gone.png\n");
  const Loaded loaded = load(folder.write("a.obj", kTwoColours), {library, png});
  ASSERT_EQ(loaded.parts.size(), 2U);
  EXPECT_EQ(loaded.parts[0].look.material.albedo_map, png);
  EXPECT_NEAR(loaded.parts[0].look.material.diffuse_rgb.x, 0.2, 1e-6);
  EXPECT_EQ(loaded.parts[1].look.material.albedo_map, "");
  EXPECT_EQ(loaded.parts[1].look.material.diffuse_rgb, (Vec3{0.0, 0.0, 1.0}));
  EXPECT_THAT(loaded.warnings, ElementsAre(HasSubstr("'gone.png'")));
}

// A binary glTF file of one triangle: a JSON chunk, then the corners and `more`.
std::string glb(const std::string& json, const std::string& more = "") {
  const auto word = [](std::size_t value) {
    std::string bytes(4, '\0');
    for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(value >> (8 * i) & 0xFF);
    return bytes;
  };
  const auto padded = [](std::string text, char pad) {
    text.resize((text.size() + 3) / 4 * 4, pad);
    return text;
  };
  std::string corners;
  for (const float f : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) {
    corners.append(4, '\0');
    std::memcpy(corners.data() + corners.size() - 4, &f, 4);
  }
  const std::string text = padded(json, ' '), data = padded(corners + more, '\0');
  return "glTF" + word(2) + word(28 + text.size() + data.size()) + word(text.size()) + "JSON" +
         text + word(data.size()) + std::string("BIN\0", 4) + data;
}

std::string gltf(const std::string& attributes, const std::string& rest) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0)" +
         attributes + R"(},"material":0}]}],)" + rest + "}";
}

TEST(MeshLookTest, ReadsGlbWithAPictureInTheFile) {
  const std::string png = picture();
  const std::string json = gltf(
      "", R"("materials":[{"doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":[1,0.5,1,1],
      "baseColorTexture":{"index":0}}}],"textures":[{"source":0}],
      "images":[{"bufferView":1,"mimeType":"image/png"}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
      "min":[0,0,0],"max":[1,1,0]}],
      "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},
      {"buffer":0,"byteOffset":36,"byteLength":)" +
              std::to_string(png.size()) + R"(}],"buffers":[{"byteLength":)" +
              std::to_string(36 + png.size()) + "}]");
  const ScratchFolder folder;
  const Loaded loaded = load(folder.write("a.glb", glb(json, png)));
  ASSERT_EQ(loaded.parts.size(), 1U);
  ASSERT_TRUE(loaded.parts[0].look.picture);
  EXPECT_GT(loaded.parts[0].look.picture->width_px, 1);
  EXPECT_EQ(loaded.parts[0].look.material.diffuse_rgb, (Vec3{1.0, 0.5, 1.0}));
  EXPECT_EQ(loaded.parts[0].mesh.triangles.size(), 2U) << "seen from both sides";
  EXPECT_THAT(loaded.warnings, IsEmpty());
}

TEST(MeshLookTest, VerticesPaintATriangleInTheirMeanColour) {
  std::string colours;
  for (const float f : {1.F, 0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 0.F, 0.F}) {
    colours.append(4, '\0');
    std::memcpy(colours.data() + colours.size() - 4, &f, 4);
  }
  const std::string json =
      gltf(R"(,"COLOR_0":1)",
           R"("materials":[{"name":"m"}],"accessors":[{"bufferView":0,"componentType":5126,
      "count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
      {"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"}],
      "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},
      {"buffer":0,"byteOffset":36,"byteLength":36}],"buffers":[{"byteLength":72}])");
  const ScratchFolder folder;
  const Loaded loaded = load(folder.write("a.glb", glb(json, colours)));
  ASSERT_EQ(loaded.parts.size(), 1U);
  const auto& picture = loaded.parts[0].look.picture;
  ASSERT_TRUE(picture);
  for (const raster::Mesh::Vertex& v : loaded.parts[0].mesh.vertices) {
    const auto x = static_cast<std::size_t>(v.uv[0] * static_cast<float>(picture->width_px));
    const auto y = static_cast<std::size_t>(v.uv[1] * static_cast<float>(picture->height_px));
    const std::size_t at = 4 * (y * static_cast<std::size_t>(picture->width_px) + x);
    EXPECT_THAT(std::vector<int>(picture->rgba.begin() + static_cast<std::ptrdiff_t>(at),
                                 picture->rgba.begin() + static_cast<std::ptrdiff_t>(at + 4)),
                ElementsAre(255, 0, 0, 255));
  }
}

TEST(MeshLookTest, EachStepOfThePaletteIsItsColour) {
  const auto colours = palette();
  EXPECT_EQ(colours->rgba.size(), std::size_t{4} * 64 * 64 * 64);
  EXPECT_EQ(colours->rgba[0], 0);
  EXPECT_EQ(colours->rgba[colours->rgba.size() - 2], 255);
}

// A triangle with this <lambert>.
std::string collada_triangle(const std::string& lambert) {
  return R"(<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert>)" +
         lambert + R"(</lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="s"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#s"/></vertices><triangles count="1" material="p">
<input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="c"><node><instance_geometry url="#g"><bind_material>
<technique_common><instance_material symbol="p" target="#m"/></technique_common></bind_material>
</instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#c"/></scene></COLLADA>)";
}

TEST(MeshLookTest, ColladaHasAnAmbientColourOfItsOwnOrThatOfGazebo) {
  const ScratchFolder folder;
  const std::string diffuse = "<diffuse><color>0.5 0.5 0.5 1</color></diffuse>";
  for (const auto& [ambient, expected] : std::vector<std::pair<std::string, double>>{
           {"", 0.4}, {"<ambient><color>0.2 0.2 0.2 1</color></ambient>", 0.2}}) {
    const Loaded loaded = load(folder.write("a.dae", collada_triangle(ambient + diffuse)));
    ASSERT_EQ(loaded.parts.size(), 1U);
    EXPECT_NEAR(loaded.parts[0].look.material.ambient_rgb.x, expected, 1e-6);
    EXPECT_NEAR(loaded.parts[0].look.material.diffuse_rgb.x, 0.5, 1e-6);
  }
}

}  // namespace
}  // namespace tether::sim
