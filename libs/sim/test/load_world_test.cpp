#include "sdf_folder.h"

#include <cmath>
#include <numbers>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using uav::Vec3;

const std::filesystem::path kSource = TETHER_SOURCE_DIR;

void expect_near(const Vec3& actual, const Vec3& expected, double tolerance = 1e-9) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
}

TEST(LoadWorld, PutsAModelWhereItsFrameSays) {
  const SdfFolder folder;
  const auto world = load({folder.write("w.sdf", world_sdf(R"(
      <frame name='table'><pose>1 2 3 0 0 1.5707963267948966</pose></frame>
      <model name='m'>
        <pose relative_to='table'>0.5 0 0 0 0 0</pose>
        <frame name='f'><pose>0 0 1 0 0 0</pose></frame>
        <link name='l'>
          <pose relative_to='f'>0 0.25 0 0 0 0</pose>
          <visual name='v'><pose relative_to='__model__'>0 0 2 0 0 0</pose>
            <geometry><sphere><radius>0.1</radius></sphere></geometry></visual>
        </link>
      </model>)")),
                           {},
                           {}})
                         .world;
  ASSERT_EQ(world.models.size(), 1u);
  const Model& model = world.models[0];
  expect_near(model.X_WM.p, {1.0, 2.5, 3.0});
  const uav::Pose X_WL = model.X_WM * model.links[0].X_ML;
  expect_near(X_WL.p, {0.75, 2.5, 4.0});
  expect_near((X_WL * model.links[0].visuals[0].X_LV).p, {1.0, 2.5, 5.0});
}

TEST(LoadWorld, ReadsShapesAndMaterials) {
  const SdfFolder folder;
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
        <surface><friction><ode><mu>0.5</mu></ode></friction></surface></collision>)")),
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
}

TEST(LoadWorld, ReadsInertiaAboutPrincipalAxes) {
  const SdfFolder folder;
  const auto world = load({folder.write("w.sdf", world_sdf(R"(
      <model name='m'><link name='l'><inertial><mass>2</mass><pose>0 0 0.5 0 0 0</pose>
        <inertia><ixx>2</ixx><iyy>2</iyy><izz>3</izz><ixy>0.5</ixy><ixz>0</ixz><iyz>0</iyz></inertia>
      </inertial></link></model>)")),
                           {},
                           {}})
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

TEST(LoadWorld, ReadsPhysicsSceneAndLights) {
  const SdfFolder folder;
  const auto loaded = load({folder.write("w.sdf", world_sdf(R"(
      <physics name='p' type='ode'><max_step_size>0.002</max_step_size>
        <real_time_factor>1</real_time_factor></physics>
      <gravity>0 0 -1.62</gravity>
      <scene><ambient>0.25 0.25 0.25 1</ambient><background>0 0.5 1 1</background></scene>
      <light name='lamp' type='spot'><pose>1 2 3 0 0 0</pose><cast_shadows>true</cast_shadows>
        <diffuse>0.5 0.5 0.5 1</diffuse><intensity>0.5</intensity><direction>1 0 0</direction>
        <attenuation><range>9</range><constant>0.5</constant><linear>0.25</linear>
          <quadratic>0.125</quadratic></attenuation>
        <spot><inner_angle>0.5</inner_angle><outer_angle>0.75</outer_angle><falloff>2</falloff></spot></light>
      <light name='sun' type='directional'/>)")),
                            {},
                            {}});
  EXPECT_THAT(loaded.warnings, IsEmpty());
  const World& world = loaded.world;
  EXPECT_EQ(world.step, std::chrono::milliseconds(2));
  EXPECT_DOUBLE_EQ(world.gravity_m_s2, 1.62);
  EXPECT_EQ(world.ambient_rgb, (Vec3{0.25, 0.25, 0.25}));
  EXPECT_EQ(world.background_rgb, (Vec3{0, 0.5, 1}));
  ASSERT_EQ(world.lights.size(), 2u);
  const Light& lamp = world.lights[0];
  EXPECT_EQ(lamp.kind, LightKind::kSpot);
  EXPECT_TRUE(lamp.cast_shadows);
  EXPECT_EQ(lamp.X_WL.p, (Vec3{1, 2, 3}));
  EXPECT_EQ(lamp.direction, (Vec3{1, 0, 0}));
  EXPECT_EQ(lamp.diffuse_rgb, (Vec3{0.25, 0.25, 0.25}));
  EXPECT_EQ(lamp.attenuation_quadratic, 0.125);
  EXPECT_EQ(lamp.spot_outer_angle_rad, 0.75);
  EXPECT_EQ(world.lights[1].kind, LightKind::kDirectional);
}

TEST(LoadWorld, SceneWithoutShadowsTakesThemFromEveryLight) {
  const SdfFolder folder;
  const auto file = folder.write("w.sdf", world_sdf(R"(<scene><shadows>false</shadows></scene>
      <light name='sun' type='directional'><cast_shadows>true</cast_shadows></light>)"));
  EXPECT_FALSE(load({file, {}, {}}).world.lights.at(0).cast_shadows);
}

TEST(LoadWorld, FindsIncludesByModelUriAndRelativeToTheFile) {
  const SdfFolder folder;
  folder.write("models/thing/model.config",
               "<model><name>thing</name><sdf version='1.7'>model.sdf</sdf></model>");
  folder.write("models/thing/mesh.stl", "solid");
  folder.write("models/thing/model.sdf", R"(<sdf version='1.7'><model name='thing'><link name='l'>
      <visual name='v'><geometry><mesh><uri>mesh.stl</uri><scale>2 2 2</scale></mesh></geometry></visual>
      </link></model></sdf>)");
  const auto loaded = load({folder.write("worlds/w.sdf", world_sdf(R"(
      <include><uri>model://thing</uri><name>a</name><pose>1 0 0 0 0 0</pose></include>
      <include><uri>../models/thing</uri><name>b</name><static>true</static></include>)")),
                            {},
                            {}});
  EXPECT_THAT(loaded.warnings, IsEmpty());
  ASSERT_EQ(loaded.world.models.size(), 2u);
  EXPECT_EQ(loaded.world.models[0].name, "a");
  EXPECT_EQ(loaded.world.models[0].X_WM.p, (Vec3{1, 0, 0}));
  EXPECT_TRUE(loaded.world.models[1].is_static);
  const auto& mesh =
      std::get<MeshGeometry>(loaded.world.models[1].links.at(0).visuals.at(0).geometry);
  EXPECT_TRUE(std::filesystem::exists(mesh.file));
  EXPECT_EQ(mesh.scale, (Vec3{2, 2, 2}));
}

TEST(LoadWorld, NestedModelsBecomeModelsOfTheirOwn) {
  const SdfFolder folder;
  const auto world = load({folder.write("w.sdf", world_sdf(R"(
      <model name='outer'><static>true</static><pose>1 0 0 0 0 0</pose><link name='l'/>
        <model name='inner'><pose>0 2 0 0 0 0</pose><link name='l'/></model></model>)")),
                           {},
                           {}})
                         .world;
  ASSERT_EQ(world.models.size(), 2u);
  EXPECT_EQ(world.models[1].name, "outer::inner");
  EXPECT_EQ(world.models[1].X_WM.p, (Vec3{1, 2, 0}));
  EXPECT_TRUE(world.models[1].is_static);
}

/// One world with an anchor of each shape.
const char* const kAnchors = R"(
    <model name='box'><static>true</static><pose>1 0 0 0 0 0</pose><link name='l'>
      <pose>0 1 0 0 0 0</pose><visual name='v'><pose>0 0 1 0 0 0</pose>
      <geometry><box><size>1 2 3</size></box></geometry>
      <material><diffuse>0 0.25 1 1</diffuse></material></visual></link></model>
    <model name='cylinder'><link name='l'><visual name='v'>
      <geometry><cylinder><radius>0.5</radius><length>2</length></cylinder></geometry></visual></link></model>
    <model name='sphere'><link name='l'><visual name='v'>
      <geometry><sphere><radius>0.5</radius></sphere></geometry></visual></link></model>
    <model name='two'><link name='l'>
      <visual name='v'><geometry><sphere><radius>0.5</radius></sphere></geometry></visual>
      <visual name='w'><geometry><sphere><radius>0.5</radius></sphere></geometry></visual></link></model>
    <model name='plane'><link name='l'><visual name='v'><geometry><plane/></geometry></visual></link></model>
    <model name='textured'><link name='l'><visual name='v'>
      <geometry><sphere><radius>0.5</radius></sphere></geometry>
      <material><pbr><metal><albedo_map>t.png</albedo_map></metal></pbr></material></visual></link></model>)";

TEST(LoadWorld, ReadsAnchors) {
  const SdfFolder folder;
  folder.write("t.png", "png");
  const auto file = folder.write("w.sdf", world_sdf(kAnchors));
  const auto anchors = load({file, {}, {"cylinder", "box", "sphere"}}).world.anchors;
  ASSERT_EQ(anchors.size(), 3u);
  EXPECT_EQ(anchors[0].anchor.shape, uav::AnchorShape::kCylinder);
  EXPECT_EQ(anchors[0].anchor.size_m, (Vec3{1, 1, 2}));
  EXPECT_EQ(anchors[1].anchor.name, "box");
  EXPECT_EQ(anchors[1].anchor.size_m, (Vec3{1, 2, 3}));
  EXPECT_EQ(anchors[1].anchor.color_rgb, (Vec3{0, 0.25, 1}));
  EXPECT_EQ(anchors[1].X_WA.p, (Vec3{1, 1, 1}));
  EXPECT_EQ(anchors[2].anchor.size_m, (Vec3{1, 1, 1}));
}

TEST(LoadWorld, RefusesWhatCannotBeAnAnchor) {
  const SdfFolder folder;
  folder.write("t.png", "png");
  const auto file = folder.write("w.sdf", world_sdf(kAnchors));
  const auto refused = [&](const std::string& anchor) { return refusal({file, {}, {anchor}}); };
  EXPECT_THAT(refused("nothing"),
              HasSubstr("w.sdf: anchor 'nothing' is no model of the world; models are box, "));
  EXPECT_THAT(refused("two"), HasSubstr("w.sdf:12: anchor 'two' has 2 visuals"));
  EXPECT_THAT(refused("plane"), HasSubstr("neither a box nor a cylinder nor a sphere"));
  EXPECT_THAT(refused("textured"), HasSubstr("is textured"));
}

TEST(LoadWorld, PlacesUavs) {
  const auto model = kSource / "models/hummingbird/model.sdf";
  const auto world = load({kSource / "worlds/room.sdf",
                           {{"a", model, {1, 2, 3}, 0.5 * pi}, {"b", model, {4, 5, 6}, 0.0}},
                           {}})
                         .world;
  ASSERT_EQ(world.uavs.size(), 2u);
  EXPECT_EQ(world.uavs[0].name, "a");
  EXPECT_EQ(world.uavs[0].X_WB.p, (Vec3{1, 2, 3}));
  expect_near(uav::rotate(world.uavs[0].X_WB.q, {1, 0, 0}), {0, 1, 0});
  EXPECT_THAT(refusal({kSource / "worlds/room.sdf", {{"a", model, {}}, {"a", model, {}}}, {}}),
              HasSubstr("two UAVs have the name 'a'"));
}

TEST(LoadWorld, LeavesTheConsoleAlone) {
  const SdfFolder folder;
  const auto bad = folder.write("w.sdf", link_sdf("<inertial><mass>heavy</mass></inertial>"));
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  EXPECT_NE(refusal({bad, {}, {}}), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace tether::sim
