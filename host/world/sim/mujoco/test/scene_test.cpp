#include "scene.h"

#include "test_simulator.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/sim_raster/scene.h>

namespace tether::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::no_warnings;
using testing::test_world;

std::vector<std::string> warnings_of(const World& world) {
  std::vector<std::string> warnings;
  make_scene(world, [&](const Warning& w) { warnings.push_back(to_line(w)); });
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
  const raster::SceneParts scene = make_scene(world, no_warnings());
  ASSERT_EQ(scene.instances.size(), 2U);
  EXPECT_FALSE(scene.instances[0].body.has_value());
  EXPECT_EQ(scene.instances[0].X_BV.p, (uav::Vec3{0.0, 0.0, -0.05}));
  EXPECT_EQ(scene.instances[1].body, 0U);
  EXPECT_EQ(scene.instances[1].X_BV.p, (uav::Vec3{0.0, 0.0, 0.02}));
  EXPECT_NE(scene.instances[0].entity, scene.instances[1].entity);
}

TEST(SceneTest, PartsBehindJointsAreBodiesThatAreHiddenWithTheirUav) {
  World world = test_world();
  world.uavs.push_back(testing::test_uav("beta", {2.0, 0.0, 1.0}));
  world.uavs[0].joints = {{"yaw", {}, {0, 0, 1}, -1, 1, 1}};
  world.uavs[1].joints = {{"yaw", {}, {0, 0, 1}, -1, 1, 1}, {"pitch", {}, {0, 1, 0}, -1, 1, 1}};
  world.uavs[1].body.visuals.push_back(testing::box_visual({0.1, 0.1, 0.1}, {1, 0, 0}));
  world.uavs[1].body.visuals.back().joints = 2;
  const raster::SceneParts scene = make_scene(world, no_warnings());
  ASSERT_EQ(scene.instances.size(), 4U);
  EXPECT_EQ(scene.instances[2].body, 1U);
  EXPECT_EQ(scene.instances[3].body, 2U + 2U);  // the third of both UAVs' joints
  EXPECT_EQ(scene.instances[3].hidden_with, 1U);
  EXPECT_EQ(scene.instances[3].entity, scene.instances[2].entity);
}

TEST(SceneTest, HasAsManyLightsAsTheRendererTakes) {
  World world = test_world();
  for (int i = 0; i < 34; ++i) world.lights.push_back(light_named("l" + std::to_string(i)));
  EXPECT_THAT(warnings_of(world), ElementsAre(HasSubstr("'l32'"), HasSubstr("'l33'")));
}

TEST(SceneTest, WarnsOfAPointLightThatShouldCastShadows) {
  World world = test_world();
  world.lights = {light_named("lamp"), light_named("spot")};
  for (Light& light : world.lights) light.cast_shadows = true;
  world.lights[1].kind = LightKind::kSpot;
  EXPECT_THAT(warnings_of(world), ElementsAre(HasSubstr("'lamp'")));
}

// Values that an SDF file may have.
TEST(SceneTest, LightsThatFadeAtOnceOrNeverAreDrawn) {
  for (const double factor : {0.0, 1e30}) {
    World world = test_world();
    world.lights = {light_named("lamp")};
    world.lights[0].attenuation_constant = factor;
    world.lights[0].attenuation_linear = factor;
    world.lights[0].attenuation_quadratic = factor;
    const raster::Scene scene(make_scene(world, no_warnings()));
  }
}

TEST(SceneTest, HalvesTheLargestTexturesBeyondTheLimit) {
  const ScratchFolder scratch;
  const std::vector<std::uint8_t> grey(std::size_t{6000} * 6000, 90);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.format = PNG_FORMAT_GRAY;
  image.width = image.height = 6000;
  World world = test_world();
  for (Link* link : {&world.models[0].links[0], &world.uavs[0].body}) {
    const auto file = scratch.path(link == &world.uavs[0].body ? "b.png" : "a.png");
    ASSERT_NE(png_image_write_to_file(&image, file.c_str(), 0, grey.data(), 0, nullptr), 0);
    link->visuals[0].material.albedo_map = file;
  }
  std::vector<Warning> warnings;
  const raster::SceneParts scene =
      make_scene(world, [&](const Warning& warning) { warnings.push_back(warning); });
  ASSERT_EQ(scene.textures.size(), 2U);
  EXPECT_EQ(std::min(scene.textures[0].width_px, scene.textures[1].width_px), 3000);
  EXPECT_EQ(std::max(scene.textures[0].width_px, scene.textures[1].width_px), 6000);
  for (const raster::Texture& texture : scene.textures) EXPECT_EQ(texture.rgba.back(), 255);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_FALSE(warnings[0].can_change_verdict);
}

TEST(SceneTest, GoesWithoutAnUnreadableTextureUnlessStrict) {
  const ScratchFolder scratch;
  World world = test_world();
  world.models[0].links[0].visuals[0].material.albedo_map = scratch.write("a.png", "no picture");
  EXPECT_THAT(warnings_of(world), ElementsAre(HasSubstr("a.png")));
  world.is_strict = true;
  EXPECT_EQ(bad_file_error([&] { make_scene(world, no_warnings()); }).where().file,
            world.models[0].links[0].visuals[0].material.albedo_map);
}

TEST(SceneTest, AMeshWithTheLookOfItsFileIsAnInstanceForEachMaterial) {
  const ScratchFolder scratch;
  MeshGeometry mesh{scratch.write("a.obj",
                                  "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n"
                                  "usemtl blue\nf 1 3 2\n"),
                    "",
                    {1.0, 1.0, 1.0}};
  mesh.companions = {scratch.write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n")};
  World world = test_world();
  std::vector<Visual>& visuals = world.models[0].links[0].visuals;
  visuals.resize(1);
  visuals[0].geometry = mesh;
  visuals[0].has_look_of_mesh = true;
  visuals[0].material.diffuse_rgb = visuals[0].material.ambient_rgb = {1.0, 1.0, 1.0};
  visuals.push_back(visuals[0]);
  visuals[1].material.alpha = 0.5;
  visuals[1].material.diffuse_rgb = {0.5, 0.5, 0.5};
  const raster::SceneParts scene = make_scene(world, no_warnings());
  ASSERT_EQ(scene.instances.size(), 4U + world.uavs[0].body.visuals.size());
  EXPECT_EQ(scene.materials[scene.instances[0].material].diffuse, (raster::Rgb{1.0F, 0.0F, 0.0F}));
  EXPECT_EQ(scene.materials[scene.instances[1].material].diffuse, (raster::Rgb{0.0F, 0.0F, 1.0F}));
  EXPECT_EQ(scene.materials[scene.instances[1].material].alpha, 1.0F);
  EXPECT_EQ(scene.instances[2].mesh, scene.instances[0].mesh) << "read once";
  EXPECT_EQ(scene.materials[scene.instances[3].material].alpha, 0.5F);
  EXPECT_EQ(scene.materials[scene.instances[3].material].diffuse, (raster::Rgb{0.0F, 0.0F, 0.5F}));
}

TEST(SceneTest, LightsKeepTheirKindAndDirection) {
  World world = test_world();
  world.lights = {light_named("point"), light_named("sun"), light_named("spot")};
  world.lights[1].kind = LightKind::kDirectional;
  world.lights[1].X_WL.q = uav::from_axis_angle({1.0, 0.0, 0.0}, 3.14159265358979);
  world.lights[2].kind = LightKind::kSpot;
  world.lights[2].spot_outer_angle_rad = 1.0471975511965976;
  const raster::SceneParts scene = make_scene(world, no_warnings());
  ASSERT_EQ(scene.lights.size(), 3U);
  EXPECT_EQ(scene.lights[0].kind, raster::LightKind::kPoint);
  EXPECT_EQ(scene.lights[1].kind, raster::LightKind::kDirectional);
  EXPECT_NEAR(scene.lights[1].direction_W.z, 1.0, 1e-6);
  EXPECT_EQ(scene.lights[2].kind, raster::LightKind::kSpot);
  EXPECT_NEAR(scene.lights[2].spot_half_angle_rad, 0.5235987755982988, 1e-9) << "half of the cone";
}

TEST(SceneTest, FilesAreReadOnce) {
  World world = test_world();
  const std::filesystem::path data = std::filesystem::path(TETHER_TEST_DIR) / "data";
  for (Link* link : {&world.models[0].links[0], &world.uavs[0].body}) {
    link->visuals[0].material.albedo_map = data / "quarters.png";
    link->visuals[0].geometry = MeshGeometry{data / "tetra.stl", "", {1.0, 1.0, 1.0}};
  }
  const raster::SceneParts scene = make_scene(world, no_warnings());
  EXPECT_EQ(scene.meshes.size(), 1U);
  ASSERT_EQ(scene.textures.size(), 1U);
  EXPECT_EQ(scene.materials[1].texture, 0U);
}

}  // namespace
}  // namespace tether::sim
