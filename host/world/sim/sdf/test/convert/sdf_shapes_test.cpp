#include "sdf_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string shown(const std::string& geometry) {
  return "<model name='m'><static>true</static><link name='l'><visual name='v'><geometry>" +
         geometry + "</geometry></visual></link></model>";
}

const Visual* only_visual(const Loaded& loaded) {
  const auto& visuals = loaded.world.models.at(0).links.at(0).visuals;
  return visuals.empty() ? nullptr : &visuals[0];
}

std::size_t times(const std::string& text, const std::string& wanted) {
  std::size_t n = 0;
  for (std::size_t at = text.find(wanted); at != std::string::npos;
       at = text.find(wanted, at + wanted.size()))
    ++n;
  return n;
}

TEST(SdfShapes, AConeIsAMeshWithItsTipAbove) {
  const Loaded loaded = load_content(shown("<cone><radius>0.5</radius><length>3</length></cone>"));
  EXPECT_THAT(loaded.warnings, IsEmpty());
  const auto& mesh = std::get<MeshGeometry>(only_visual(loaded)->geometry);
  ASSERT_TRUE(mesh.made);
  EXPECT_EQ(times(*mesh.made, "\nv 0.000000 0.000000 1.500000"), 32u);
  EXPECT_EQ(times(*mesh.made, "\nf "), 64u);
  EXPECT_FALSE(only_visual(loaded)->has_look_of_mesh);
}

// An L: six sides, and four triangles on either end, whichever way its points turn.
TEST(SdfShapes, APolylineIsExtruded) {
  const std::string left =
      "<point>0 0</point><point>2 0</point><point>2 1</point><point>1 1</point><point>1 2</point>"
      "<point>0 2</point>";
  const std::string right =
      "<point>0 2</point><point>1 2</point><point>1 1</point><point>2 1</point><point>2 0</point>"
      "<point>0 0</point>";
  for (const std::string& points : {left, right}) {
    const Loaded loaded =
        load_content(shown("<polyline>" + points + "<height>0.5</height></polyline>"));
    EXPECT_THAT(loaded.warnings, IsEmpty());
    const std::string text = *std::get<MeshGeometry>(only_visual(loaded)->geometry).made;
    EXPECT_EQ(times(text, "\nf "), 6u + 2u * 4u);
    EXPECT_EQ(times(text, " 0.500000\n"), 2u * 6u + 3u * 4u);
  }
}

TEST(SdfShapes, ARoadIsAStripAlongItsPoints) {
  const Loaded loaded = load_content(R"(<road name='r'><width>2</width><point>0 0 0</point>
      <point>4 0 0</point><point>4 6 1</point><material><diffuse>1 0 0 1</diffuse></material></road>
      <road name='short'><width>1</width><point>0 0 0</point></road>)");
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_EQ(loaded.warnings[0].subject, "road 'short'");
  ASSERT_EQ(loaded.world.models.size(), 1u);
  EXPECT_TRUE(loaded.world.models[0].links.at(0).collisions.empty());
  const std::string text = *std::get<MeshGeometry>(only_visual(loaded)->geometry).made;
  EXPECT_EQ(times(text, "\nf "), 2u);
  EXPECT_THAT(text, HasSubstr("v 0.000000 1.000000 0.010000\n"));
  EXPECT_THAT(text, HasSubstr("vt 1.000000 2.000000\n"));
  EXPECT_EQ(only_visual(loaded)->material.diffuse_rgb, (uav::Vec3{1, 0, 0}));
}

TEST(SdfShapes, AHeightmapIsItsPicture) {
  const ScratchFolder folder;
  folder.write("h.png", "");
  const std::string sized =
      "<heightmap><uri>h.png</uri><size>20 30 4</size><pos>1 2 3</pos></heightmap>";
  const Loaded loaded = load({folder.write("w.sdf", world_sdf(shown(sized))), {}, {}});
  EXPECT_THAT(loaded.warnings, IsEmpty());
  const Visual& ground = *only_visual(loaded);
  EXPECT_EQ(std::get<MeshGeometry>(ground.geometry).file, folder.path() / "h.png");
  EXPECT_EQ(std::get<MeshGeometry>(ground.geometry).scale, (uav::Vec3{20.0, 30.0, 4.0}));
  EXPECT_EQ(ground.X_LV.p, (uav::Vec3{1.0, 2.0, 3.0}));
  EXPECT_FALSE(ground.has_look_of_mesh);
}

TEST(SdfShapes, ThoseThatCannotBeMadeAreLeftOutAndNamed) {
  for (const auto& [shape, message] : std::vector<std::pair<std::string, std::string>>{
           {"<cone><radius>1</radius></cone>", "<length>"},
           {"<polyline><point>0 0</point><point>1 0</point><height>1</height></polyline>",
            "3 to 1000 points"},
           {"<heightmap><uri>gone.png</uri></heightmap>", "'gone.png', which is not found"},
           {"<heightmap><uri>gone.png</uri><size>1 1 0</size></heightmap>", "gone.png"}}) {
    const Loaded loaded = load_content(shown(shape));
    EXPECT_EQ(only_visual(loaded), nullptr);
    EXPECT_THAT(loaded.warnings, ElementsAre(testing::Field(&Warning::message, HasSubstr(message))))
        << shape;
  }
}

}  // namespace
}  // namespace tether::sim
