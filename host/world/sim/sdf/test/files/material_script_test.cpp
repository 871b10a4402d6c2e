#include "files/material_script.h"

#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using uav::Vec3;

ScriptMaterial read(const std::string& text, const std::string& name = "a") {
  ScriptMaterials materials;
  read_script(text, materials);
  const auto found = materials.find(name);
  EXPECT_NE(found, materials.end()) << name;
  return found != materials.end() ? found->second : ScriptMaterial{};
}

TEST(MaterialScript, ReadsColoursAndTheTextureOfTheFirstTechnique) {
  const ScriptMaterial material = read(R"(
// material b { }
material a
{
  receive_shadows on
  technique { pass {
      ambient 0.5 0.25 0.125 1
      diffuse 1 2 -1 0.5
      specular 0.1 0.2 0.3 1 12.5
      emissive 0 0 0.5
      /* texture_unit { texture other.png } */
      texture_unit
      {
        texture "red wall.png"
        scale 0.5 0.25
        filtering trilinear
      }
      vertex_program_ref p { param_named diffuse float 3 }
  } }
  technique { pass { diffuse 0 0 0 } }
})");
  EXPECT_EQ(material.ambient_rgb, (Vec3{0.5, 0.25, 0.125}));
  EXPECT_EQ(material.diffuse_rgb, (Vec3{1.0, 1.0, 0.0})) << "within 0 to 1";
  EXPECT_EQ(material.specular_rgb, (Vec3{0.1, 0.2, 0.3}));
  EXPECT_EQ(material.emissive_rgb, (Vec3{0.0, 0.0, 0.5}));
  EXPECT_FALSE(material.alpha) << "it does not blend";
  EXPECT_EQ(material.texture, "red wall.png");
  EXPECT_EQ(material.texture_scale_x, 0.5);
  EXPECT_EQ(material.texture_scale_y, 0.25);
}

TEST(MaterialScript, ReadsTransparencyAndSides) {
  EXPECT_EQ(read("material a { technique { pass { scene_blend alpha_blend\ncull_hardware none\n"
                 "diffuse 1 1 1 0.25\n} } }")
                .alpha,
            0.25);
  const ScriptMaterial manual = read(
      "material a\n{\ntechnique\n{\npass\n{\nscene_blend alpha_blend\ntexture_unit\n{\n"
      "colour_op_ex source1 src_manual src_current 1 0 0\n"
      "alpha_op_ex source1 src_manual src_current 0.5\n}\n}\n}\n}");
  EXPECT_EQ(manual.alpha, 0.5);
  EXPECT_EQ(manual.diffuse_rgb, (Vec3{1.0, 0.0, 0.0}));
  EXPECT_TRUE(read("material a{\ntechnique{\npass{\ncull_hardware none\n}\n}\n}").is_double_sided);
}

TEST(MaterialScript, LightingOffShinesByItself) {
  const ScriptMaterial material = read(
      "material a\n{\ntechnique\n{\npass\n{\nlighting off\ntexture_unit\n{\n"
      "texture t.png\n}\n}\n}\n}");
  EXPECT_EQ(material.emissive_rgb, (Vec3{1.0, 1.0, 1.0}));
  EXPECT_EQ(material.diffuse_rgb, (Vec3{}));
}

TEST(MaterialScript, LaterPassesAndBasesFillIn) {
  const std::string text =
      "material base\n{\ntechnique\n{\npass\n{\nambient 1 0 0\n}\npass\n{\nambient 0 1 0\n"
      "diffuse 0 0 1\n}\n}\n}\nmaterial a : base\n{\ntechnique\n{\npass\n{\nspecular 1 1 1 5\n"
      "}\n}\n}\nmaterial b : Gazebo/Red\n{\n}\n";
  const ScriptMaterial material = read(text);
  EXPECT_EQ(material.ambient_rgb, (Vec3{1.0, 0.0, 0.0}));
  EXPECT_EQ(material.diffuse_rgb, (Vec3{0.0, 0.0, 1.0}));
  EXPECT_EQ(material.specular_rgb, (Vec3{1.0, 1.0, 1.0}));
  EXPECT_EQ(read(text, "b").diffuse_rgb, (Vec3{1.0, 0.0, 0.0}));
}

TEST(MaterialScript, SkipsWhatItCannotRead) {
  ScriptMaterials materials;
  for (const char* text :
       {"", "}}}", "{{{", "material", "material a {", "material a : {}", "material {}",
        "material a { technique { pass { diffuse x y z\n texture_unit { texture } } } }", "/*",
        "\"", "set $x 1"})
    read_script(text, materials);
  EXPECT_LE(materials.size(), 1U);
}

TEST(MaterialScript, KnowsGazebosOwnMaterials) {
  ASSERT_NE(gazebo_material("Gazebo/Grey"), nullptr);
  EXPECT_EQ(gazebo_material("Gazebo/Grey")->ambient_rgb, (Vec3{0.3, 0.3, 0.3}));
  EXPECT_EQ(gazebo_material("Gazebo/Wood")->texture, "wood.png");
  EXPECT_EQ(gazebo_material("Gazebo/BlueTransparent")->alpha, 0.5);
  EXPECT_EQ(gazebo_material("Gazebo/Nothing"), nullptr);
}

}  // namespace
}  // namespace tether::sim
