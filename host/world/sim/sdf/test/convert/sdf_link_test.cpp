#include "sdf_folder.h"

#include <cmath>
#include <iterator>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using uav::Vec3;

TEST(SdfLink, ReadsShapesAndMaterials) {
  const ScratchFolder folder;
  folder.write("t.png", "png");
  const auto loaded = load({folder.write("w.sdf", link_sdf(R"(
      <visual name='box'><transparency>0.5</transparency><cast_shadows>false</cast_shadows>
        <geometry><box><size>1 2 3</size></box></geometry>
        <material><diffuse>0.5 0.25 0.125 0.5</diffuse><specular>0.25 0.25 0.25 1</specular>
          <emissive>0 0 0.5 1</emissive></material></visual>
      <visual name='cylinder'><geometry><cylinder><radius>0.5</radius><length>2</length></cylinder></geometry>
        <material><pbr><metal><albedo_map>t.png</albedo_map></metal></pbr>
          <tether:texture_repeat>2 0.5</tether:texture_repeat></material></visual>
      <visual name='plane'><geometry><plane><normal>0 1 0</normal><size>4 5</size></plane></geometry></visual>
      <visual name='capsule'><geometry><capsule><radius>0.5</radius><length>2</length></capsule></geometry></visual>
      <visual name='ellipsoid'><geometry><ellipsoid><radii>1 2 3</radii></ellipsoid></geometry></visual>
      <collision name='c'><geometry><sphere><radius>0.25</radius></sphere></geometry>
        <surface><friction><ode><mu>0.5</mu></ode></friction>
          <contact><collide_bitmask>0x02</collide_bitmask></contact></surface></collision>)")),
                            {},
                            {}});
  EXPECT_THAT(loaded.warnings, IsEmpty());
  const Link& link = loaded.world.models.at(0).links.at(0);
  ASSERT_EQ(link.visuals.size(), 5u);

  const Visual& box = link.visuals[0];
  EXPECT_EQ(std::get<BoxGeometry>(box.geometry).size_m, (Vec3{1, 2, 3}));
  EXPECT_FALSE(box.cast_shadows);
  EXPECT_EQ(box.material.diffuse_rgb, (Vec3{0.5, 0.25, 0.125}));
  EXPECT_EQ(box.material.ambient_rgb, box.material.diffuse_rgb);
  EXPECT_EQ(box.material.specular_rgb, (Vec3{0.25, 0.25, 0.25}));
  EXPECT_EQ(box.material.emissive_rgb, (Vec3{0, 0, 0.5}));
  EXPECT_DOUBLE_EQ(box.material.alpha, 0.25);

  const Visual& cylinder = link.visuals[1];
  EXPECT_EQ(std::get<CylinderGeometry>(cylinder.geometry).length_m, 2.0);
  EXPECT_TRUE(cylinder.material.albedo_map.is_absolute());
  EXPECT_EQ(cylinder.material.albedo_map.filename(), "t.png");
  EXPECT_EQ(cylinder.material.diffuse_rgb, (Vec3{1, 1, 1}));
  EXPECT_EQ(cylinder.material.texture_repeat_x, 2.0);
  EXPECT_EQ(cylinder.material.texture_repeat_y, 0.5);

  EXPECT_EQ(std::get<PlaneGeometry>(link.visuals[2].geometry).size_y_m, 5.0);
  EXPECT_EQ(std::get<CapsuleGeometry>(link.visuals[3].geometry).radius_m, 0.5);
  EXPECT_EQ(std::get<EllipsoidGeometry>(link.visuals[4].geometry).radii_m, (Vec3{1, 2, 3}));
  EXPECT_EQ(link.collisions.at(0).friction, 0.5);
  EXPECT_EQ(link.collisions.at(0).bits, 2U);
}

TEST(SdfLink, ReadsWhetherASubmeshIsCentered) {
  const ScratchFolder folder;
  folder.write("m.obj", "");
  const auto mesh_with = [&](const std::string& inside) {
    const auto file = folder.write("w.sdf", link_sdf("<visual name='v'><geometry><mesh><uri>m.obj"
                                                     "</uri>" +
                                                     inside + "</mesh></geometry></visual>"));
    const Loaded loaded = load({file, {}, {}, {}, {}});
    EXPECT_THAT(loaded.warnings, IsEmpty()) << inside;
    return std::get<MeshGeometry>(loaded.world.models.at(0).links.at(0).visuals.at(0).geometry);
  };
  EXPECT_FALSE(mesh_with("").is_centered);
  EXPECT_FALSE(mesh_with("<submesh><name>a</name></submesh>").is_centered);
  const MeshGeometry mesh = mesh_with("<submesh><name>a</name><center>true</center></submesh>");
  EXPECT_TRUE(mesh.is_centered);
  EXPECT_EQ(mesh.submesh, "a");
}

TEST(SdfLink, GoesWithoutMissingFilesUnlessStrict) {
  const ScratchFolder folder;
  const auto file = folder.write("w.sdf", link_sdf(R"(<visual name='a'><geometry><mesh>
      <uri>model://gone/a.dae</uri></mesh></geometry></visual>
      <visual name='b'><geometry><sphere><radius>1</radius></sphere></geometry><material><pbr><metal>
      <albedo_map>https://fuel.gazebosim.org/1.0/o/models/m/1/files/t.png</albedo_map>
      </metal></pbr></material></visual>)"));
  const Loaded loaded = load({file, {}, {}});
  EXPECT_THAT(
      loaded.warnings,
      ElementsAre(is_warning(Consequence::kMissing, file, 6, "<uri> of visual 'a'"),
                  is_warning(Consequence::kLooksDifferent, file, 8, "<albedo_map> of visual 'b'")));
  EXPECT_EQ(loaded.world.models.at(0).links.at(0).visuals.size(), 1u);
}

TEST(SdfLink, ReadsInertiaAboutPrincipalAxes) {
  const World world = load_content(R"(
      <model name='m'><link name='l'><inertial><mass>2</mass><pose>0 0 0.5 0 0 0</pose>
        <inertia><ixx>2</ixx><iyy>2</iyy><izz>3</izz><ixy>0.5</ixy><ixz>0</ixz><iyz>0</iyz></inertia>
      </inertial></link></model>)")
                          .world;
  const Link& link = world.models.at(0).links.at(0);
  EXPECT_FALSE(world.models[0].is_static);
  EXPECT_EQ(link.mass_kg, 2.0);
  EXPECT_EQ(link.X_LI.p, (Vec3{0, 0, 0.5}));
  const std::multiset<double> moments{link.inertia_kg_m2.x, link.inertia_kg_m2.y,
                                      link.inertia_kg_m2.z};
  EXPECT_NEAR(*moments.begin(), 1.5, 1e-9);
  EXPECT_NEAR(*std::next(moments.begin()), 2.5, 1e-9);

  // Rotated back to the link's axes, the moments give the matrix of the file again.
  const auto along = [&](const Vec3& axis_L) {
    const Vec3 axis = uav::rotate(uav::inverse(link.X_LI.q), axis_L);
    return link.inertia_kg_m2.x * axis.x * axis.x + link.inertia_kg_m2.y * axis.y * axis.y +
           link.inertia_kg_m2.z * axis.z * axis.z;
  };
  const double half = std::sqrt(0.5);
  EXPECT_NEAR(along({1, 0, 0}), 2.0, 1e-9);
  EXPECT_NEAR(along({half, half, 0}), 2.5, 1e-9);
}

TEST(SdfLink, ReflectsAsItsCollisionOrVisualSays) {
  const auto intensity = [](const std::string& of_collision, const std::string& visuals) {
    const ScratchFolder folder;
    const std::string sdf =
        link_sdf(visuals +
                 "<collision name='c'><geometry><sphere><radius>0.25</radius></sphere>"
                 "</geometry>" +
                 of_collision + "</collision>");
    const auto loaded = load({folder.write("w.sdf", sdf), {}, {}});
    EXPECT_THAT(loaded.warnings, IsEmpty());
    return loaded.world.models.at(0).links.at(0).collisions.at(0).intensity;
  };
  const std::string grey =
      "<visual name='v'><geometry><sphere><radius>0.25</radius></sphere></geometry>"
      "<material><diffuse>0.25 0.5 0 1</diffuse></material></visual>";
  const std::string retro =
      "<visual name='r'><geometry><sphere><radius>0.25</radius></sphere></geometry>"
      "<laser_retro>120</laser_retro></visual>";
  EXPECT_EQ(intensity("<laser_retro>7</laser_retro>", grey + retro), 7.0);
  EXPECT_EQ(intensity("", grey + retro), 120.0);
  EXPECT_NEAR(intensity("", grey), 0.25, 1e-6);
  EXPECT_EQ(intensity("", ""), 0.0);
}

}  // namespace
}  // namespace tether::sim
