#include "scene.h"

#include "test_simulator.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::no_warnings;
using testing::test_world;

std::vector<std::string> warnings_of(const World& world) {
  std::vector<std::string> warnings;
  make_scene(world, [&](const Warning& warning) { warnings.push_back(to_line(warning)); });
  return warnings;
}

Light light_named(const std::string& name) {
  Light light;
  light.name = name;
  return light;
}

TEST(SceneTest, FixedThingsAreInTheWorldFrameMovingOnesInTheirBodys) {
  World world = test_world();
  world.uavs[0].body.visuals[0].X_LV.p = {0.0, 0.0, 0.02};
  const Scene scene = make_scene(world, no_warnings());
  ASSERT_EQ(scene.items.size(), 2U);
  EXPECT_FALSE(scene.items[0].body.has_value());
  EXPECT_EQ(scene.items[0].X_BV.p, (uav::Vec3{0.0, 0.0, -0.05}));
  EXPECT_EQ(scene.items[1].body, 0U);
  EXPECT_EQ(scene.items[1].X_BV.p, (uav::Vec3{0.0, 0.0, 0.02}));
}

TEST(SceneTest, BodiesReachAsFarAsTheirFarthestVisual) {
  World world = test_world();
  world.uavs.push_back(testing::test_uav("beta", {3.0, 0.0, 1.0}));
  Visual mast = testing::box_visual({0.2, 0.2, 0.2}, {1.0, 1.0, 1.0});
  mast.X_LV.p = {0.0, 0.0, 2.0};
  world.uavs[1].body.visuals.push_back(mast);
  const std::vector<double> radii_m = body_radii_m(make_scene(world, no_warnings()), 2);
  ASSERT_EQ(radii_m.size(), 2U);
  EXPECT_NEAR(radii_m[0], norm(uav::Vec3{0.2, 0.2, 0.05}), 1e-6);
  EXPECT_NEAR(radii_m[1], 2.0 + norm(uav::Vec3{0.1, 0.1, 0.1}), 1e-6);
}

TEST(SceneTest, WarnsOfMaterialColoursThatCannotBeShown) {
  World world = test_world();
  Material& material = world.models[0].links[0].visuals[0].material;
  material.specular_rgb = {0.2, 0.2, 0.2};
  material.emissive_rgb = 0.5 * material.diffuse_rgb;
  EXPECT_THAT(warnings_of(world), ElementsAre());
  EXPECT_FLOAT_EQ(make_scene(world, no_warnings()).items[0].geom.specular, 0.2F);
  EXPECT_FLOAT_EQ(make_scene(world, no_warnings()).items[0].geom.emission, 0.5F);
  material.ambient_rgb = {1.0, 0.0, 0.0};
  material.specular_rgb = {1.0, 0.0, 0.0};
  material.emissive_rgb = {1.0, 0.0, 0.0};
  EXPECT_THAT(warnings_of(world),
              ElementsAre(HasSubstr("ambient"), HasSubstr("specular"), HasSubstr("emissive")));
}

TEST(SceneTest, HasSevenLightsBesideTheAmbientOne) {
  World world = test_world();
  for (int i = 0; i < 9; ++i) world.lights.push_back(light_named("l" + std::to_string(i)));
  EXPECT_THAT(warnings_of(world), ElementsAre(HasSubstr("'l7'"), HasSubstr("'l8'")));
}

TEST(SceneTest, LightsKeepTheirKind) {
  World world = test_world();
  world.lights = {light_named("point"), light_named("sun"), light_named("spot")};
  world.lights[1].kind = LightKind::kDirectional;
  world.lights[1].X_WL.q = uav::from_axis_angle({1.0, 0.0, 0.0}, 3.14159265358979);
  world.lights[2].kind = LightKind::kSpot;
  world.lights[2].spot_outer_angle_rad = 1.0471975511965976;
  const Scene scene = make_scene(world, no_warnings());
  ASSERT_EQ(scene.lights.size(), 4U);
  EXPECT_EQ(scene.lights[1].cutoff, 180.0F);
  EXPECT_EQ(scene.lights[2].directional, 1);
  EXPECT_NEAR(scene.lights[2].dir[2], 1.0F, 1e-6F);
  EXPECT_NEAR(scene.lights[3].cutoff, 30.0F, 1e-4F) << "half of the cone's angle";
  EXPECT_FALSE(scene.shadows);
}

TEST(SceneTest, ShadowsAreDrawnOnlyWhenALightAsksForThem) {
  World world = test_world();
  world.lights = {light_named("sun")};
  world.models[0].links[0].visuals[0].cast_shadows = false;
  EXPECT_FALSE(make_scene(world, no_warnings()).shadows);
  world.lights[0].cast_shadows = true;
  EXPECT_THAT(warnings_of(world), ElementsAre(HasSubstr("shadow")));
}

TEST(SceneTest, TexturesAreShared) {
  World world = test_world();
  const std::filesystem::path png = std::filesystem::path(TETHER_TEST_DIR) / "data/quarters.png";
  world.models[0].links[0].visuals[0].material.albedo_map = png;
  world.uavs[0].body.visuals[0].material.albedo_map = png;
  const Scene scene = make_scene(world, no_warnings());
  EXPECT_EQ(scene.textures.size(), 1U);
  EXPECT_EQ(scene.items[0].geom.texid, 0);
  EXPECT_EQ(scene.items[1].geom.texid, 0);
}

}  // namespace
}  // namespace tether::sim
