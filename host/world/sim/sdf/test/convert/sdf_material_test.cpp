#include "sdf_folder.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using uav::Vec3;

class SdfMaterial : public ::testing::Test {
 protected:
  Loaded load_visual(const std::string& geometry, const std::string& material) const {
    return load({folder_.write("w.sdf", link_sdf("<visual name='v'><geometry>" + geometry +
                                                 "</geometry>\n" + material + "</visual>")),
                 {},
                 {}});
  }
  Loaded load_box(const std::string& content) const {
    return load_visual("<box><size>1 1 1</size></box>", "<material>" + content + "</material>");
  }
  static const Visual& visual_of(const Loaded& loaded) {
    return loaded.world.models.at(0).links.at(0).visuals.at(0);
  }
  static const Material& material_of(const Loaded& loaded) { return visual_of(loaded).material; }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(folder_.path(name).parent_path());
    return folder_.write(name, text);
  }

  ScratchFolder folder_;
};

TEST(SdfMaterials, TakesTexturesOfPngAndJpegAndWarnsOfOthers) {
  const ScratchFolder folder;
  const auto load_texture = [&](const std::string& name) {
    folder.write(name, "");
    return load(
        {folder.write("w.sdf", link_sdf(R"(<visual name='v'><geometry><sphere><radius>1</radius>
        </sphere></geometry><material><pbr><metal>
        <albedo_map>)" + name + "</albedo_map></metal></pbr></material></visual>")),
         {},
         {}});
  };
  const auto texture_of = [](const Loaded& loaded) {
    return loaded.world.models.at(0).links.at(0).visuals.at(0).material.albedo_map.filename();
  };
  for (const char* name : {"t.png", "t.JPG", "t.jpeg"}) {
    const Loaded loaded = load_texture(name);
    EXPECT_EQ(texture_of(loaded), name);
    EXPECT_THAT(loaded.warnings, IsEmpty());
  }
  const Loaded loaded = load_texture("t.tga");
  EXPECT_EQ(texture_of(loaded), "");
  EXPECT_THAT(loaded.warnings,
              ElementsAre(is_warning(Consequence::kLooksDifferent, folder.path("w.sdf"), 7,
                                     "<albedo_map> of visual 'v'")));
}

TEST_F(SdfMaterial, ATextureIsOnceOnEachFaceUnlessItsRepetitionsAreGiven) {
  folder_.write("t.png", "");
  const std::string map = "<pbr><metal><albedo_map>t.png</albedo_map></metal></pbr>";
  EXPECT_EQ(material_of(load_box(map)).texture_repeat, TextureRepeat::kPerFace);
  const Loaded repeated = load_box(map + "<tether:texture_repeat>2 3</tether:texture_repeat>");
  EXPECT_EQ(material_of(repeated).texture_repeat, TextureRepeat::kPerMetre);
  EXPECT_EQ(material_of(repeated).texture_repeat_y, 3.0);
}

TEST_F(SdfMaterial, TakesGazebosMaterialsByName) {
  const std::string script =
      "<script><uri>file://media/materials/scripts/gazebo.material</uri>"
      "<name>Gazebo/Green</name></script>";
  const Loaded green = load_box(script);
  EXPECT_THAT(green.warnings, IsEmpty());
  EXPECT_EQ(material_of(green).diffuse_rgb, (Vec3{0.0, 1.0, 0.0}));
  EXPECT_EQ(material_of(green).specular_rgb, (Vec3{0.1, 0.1, 0.1}));
  const Loaded tinted = load_box(script + "<diffuse>1 0 0 0.5</diffuse>");
  EXPECT_EQ(material_of(tinted).diffuse_rgb, (Vec3{1.0, 0.0, 0.0}));
  EXPECT_EQ(material_of(tinted).ambient_rgb, (Vec3{0.0, 1.0, 0.0}));
  EXPECT_EQ(material_of(tinted).alpha, 0.5);
}

TEST_F(SdfMaterial, TakesMaterialsAndPicturesOfScripts) {
  const auto script = write("models/m/materials/scripts/m.material",
                            "material M/Wall\n{\ntechnique\n{\npass\n{\nambient 0.5 0 0\n"
                            "texture_unit\n{\ntexture wall.png\nscale 0.25 0.5\n}\n}\n}\n}\n");
  const auto picture = write("models/m/materials/textures/wall.png", "");
  for (const char* uri : {"<uri>model://m/materials/scripts</uri>",
                          "<uri>model://m/materials/scripts/m.material</uri>"}) {
    const Loaded loaded = load_box(std::string("<script>") + uri + "<name>M/Wall</name></script>");
    EXPECT_THAT(loaded.warnings, IsEmpty()) << uri;
    const Material& material = material_of(loaded);
    EXPECT_EQ(material.albedo_map, picture);
    EXPECT_EQ(material.ambient_rgb, (Vec3{0.5, 0.0, 0.0}));
    EXPECT_EQ(material.diffuse_rgb, (Vec3{1.0, 1.0, 1.0}));
    EXPECT_EQ(material.texture_repeat, TextureRepeat::kPerFace);
    EXPECT_EQ(material.texture_repeat_x, 4.0);
    EXPECT_EQ(material.texture_repeat_y, 2.0);
    EXPECT_TRUE(loaded.world.files.contains(script));
    EXPECT_TRUE(loaded.world.files.contains(picture));
  }
}

TEST_F(SdfMaterial, NamesScriptsAndPicturesThatAreNotFound) {
  const auto expect_named = [&](const Loaded& loaded, const std::string& name) {
    ASSERT_EQ(loaded.warnings.size(), 1U);
    EXPECT_THAT(loaded.warnings[0].message, HasSubstr("'" + name + "'"));
    EXPECT_EQ(loaded.warnings[0].consequence, Consequence::kLooksDifferent);
    EXPECT_TRUE(loaded.warnings[0].can_change_verdict);
  };
  expect_named(load_box("<script><name>No/Such</name></script>"), "No/Such");
  write("models/m/materials/scripts/m.material",
        "material A\n{\ntechnique\n{\npass\n{\ntexture_unit\n{\ntexture gone.png\n}\n}\n}\n}\n");
  expect_named(load_box("<script><uri>model://m/materials/scripts</uri><name>A</name></script>"),
               "gone.png");
}

TEST_F(SdfMaterial, WithoutAMaterialAMeshLooksAsItsFileSays) {
  const auto library = folder_.write("m.mtl", "newmtl red\nKd 1 0 0\n");
  folder_.write("m.obj", "mtllib m.mtl\nusemtl red\n");
  const std::string mesh = "<mesh><uri>m.obj</uri></mesh>";
  const Loaded own = load_visual(mesh, "<transparency>0.5</transparency>");
  EXPECT_TRUE(visual_of(own).has_look_of_mesh);
  EXPECT_EQ(material_of(own).alpha, 0.5);
  EXPECT_THAT(std::get<MeshGeometry>(visual_of(own).geometry).companions, ElementsAre(library));
  EXPECT_TRUE(own.world.files.contains(library));
  const std::string material = "<material><diffuse>0 1 0 1</diffuse></material>";
  EXPECT_FALSE(visual_of(load_visual(mesh, material)).has_look_of_mesh);
  const std::string unknown = "<material><script><name>No/Such</name></script></material>";
  EXPECT_TRUE(visual_of(load_visual(mesh, unknown)).has_look_of_mesh);
}

TEST_F(SdfMaterial, FinePointsAreNamedOnce) {
  folder_.write("t.png", "");
  const std::string pbr =
      "<material><pbr><metal><albedo_map>t.png</albedo_map>\n<normal_map>n.png</normal_map>"
      "<roughness>0.5</roughness></metal></pbr></material>";
  const std::string box = "<geometry><box><size>1 1 1</size></box></geometry>";
  const Loaded loaded = load(
      {folder_.write("w.sdf", link_sdf("<visual name='a'>" + box + pbr +
                                       "</visual><visual name='b'>" + box + pbr + "</visual>")),
       {},
       {}});
  EXPECT_THAT(loaded.warnings,
              ElementsAre(is_warning(Consequence::kLooksDifferent, folder_.path("w.sdf"), 6,
                                     "<normal_map> of visual 'a'")));
}

TEST_F(SdfMaterial, ASkyIsOneColour) {
  const Loaded loaded = load_content(
      "<scene><background>0 0 0 1</background>\n<sky><clouds><speed>12</speed></clouds></sky>"
      "</scene>");
  EXPECT_GT(loaded.world.background_rgb.z, loaded.world.background_rgb.x);
  ASSERT_EQ(loaded.warnings.size(), 1U);
  EXPECT_EQ(loaded.warnings[0].subject, "<sky> of world 'w'");
  EXPECT_FALSE(loaded.warnings[0].can_change_verdict);
}

}  // namespace
}  // namespace tether::sim
