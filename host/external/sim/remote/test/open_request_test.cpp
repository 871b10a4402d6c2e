#include "open_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/sim/bodies.h>
#include <tether/sim_protocol/codec.h>
#include <tether/sim_testing/busy_flight.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim {
namespace {

using testing::box_model;
using testing::busy_world;
using testing::test_uav;

World world_of_a_file() {
  World world = busy_world();
  world.file = "/worlds/busy.sdf";
  return world;
}

protocol::Open open_of(const World& world) {
  return make_open(world, [](const Warning& warning) { ADD_FAILURE() << to_line(warning); });
}

TEST(OpenRequest, DescribesTheWorld) {
  World world = world_of_a_file();
  world.step = std::chrono::milliseconds(2);
  const protocol::Open open = open_of(world);
  EXPECT_EQ(open.version, protocol::kVersion);
  EXPECT_EQ(open.world_name, "test");
  EXPECT_EQ(open.world_file, "/worlds/busy.sdf");
  EXPECT_EQ(open.gravity_m_s2, world.gravity_m_s2);
  EXPECT_EQ(open.step, world.step);
  EXPECT_TRUE(validate(protocol::Request(open)).ok());
  ASSERT_EQ(open.uavs.size(), 2u);
  EXPECT_EQ(open.uavs[1].name, "beta");
  EXPECT_EQ(open.uavs[1].X_WB, world.uavs[1].X_WB);
  EXPECT_EQ(open.uavs[1].airframe.mass_kg, world.uavs[1].airframe.mass_kg);
  EXPECT_THAT(open.uavs[1].sdf, ::testing::HasSubstr("<model name='beta'>"));
}

TEST(OpenRequest, NamesTheMovingBodiesInTheirOrder) {
  World world = world_of_a_file();
  world.models.push_back(box_model("outer::inner", {}, {1.0, 1.0, 1.0}, {}, false));
  world.models.back().links[0].name = "l";
  const protocol::Open open = open_of(world);
  ASSERT_EQ(open.uavs.size() + open.bodies.size(), moving_bodies(world).size());
  EXPECT_EQ(open.bodies[0].model, "loose");
  EXPECT_EQ(open.bodies[1].model, "outer::inner");
  EXPECT_EQ(open.bodies[1].link, "l");
}

TEST(OpenRequest, HasTheLargestViewAndTheLongestShutter) {
  World world = world_of_a_file();
  const protocol::Open open = open_of(world);
  EXPECT_EQ(open.max_width_px, 160);
  EXPECT_EQ(open.max_height_px, 120);
  EXPECT_GE(open.past_steps, 24u);
  for (Uav& uav : world.uavs) uav.sensors.erase(uav.sensors.begin());
  const protocol::Open blind = open_of(world);
  EXPECT_EQ(blind.max_width_px, 0);
  EXPECT_EQ(blind.past_steps, 0u);
}

TEST(OpenRequest, HasTheMaterialsOfTexturedVisuals) {
  World world = world_of_a_file();
  Material painted;
  painted.diffuse_rgb = {0.1, 0.2, 0.3};
  painted.albedo_map = "/textures/brick.png";
  painted.texture_repeat_x = 2.5;
  painted.alpha = 0.25;
  world.models[0].links[0].name = "ground";
  world.models[0].links[0].visuals[0].material = painted;
  Visual capsule = world.uavs[0].body.visuals[0];
  capsule.name = "arm::tube";
  capsule.geometry = CapsuleGeometry{0.1, 0.3};
  capsule.material = painted;
  world.uavs[0].body.visuals.push_back(capsule);
  const protocol::Open open = open_of(world);
  ASSERT_EQ(open.materials.size(), 4u) << "three of the capsule, one of the floor";
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(open.materials[i].model, "alpha");
    EXPECT_EQ(open.materials[i].link, "base_link");
    EXPECT_THAT(open.uavs[0].sdf,
                ::testing::HasSubstr("<visual name='" + open.materials[i].visual + "'>"));
  }
  const protocol::VisualMaterial& floor = open.materials[3];
  EXPECT_EQ(floor.model, "floor");
  EXPECT_EQ(floor.link, "ground");
  EXPECT_EQ(floor.visual, "box");
  EXPECT_EQ(floor.texture, "/textures/brick.png");
  EXPECT_EQ(floor.texture_repeat_x, 2.5);
  EXPECT_EQ(floor.alpha, 0.25);
  EXPECT_EQ(floor.diffuse_rgb, painted.diffuse_rgb);
}

// Rather than a picture without depths: with the place of the sensor.
TEST(OpenRequest, RefusesCamerasThatTheProtocolDoesNotHave) {
  for (const auto kind :
       {uav::CameraKind::kDepth, uav::CameraKind::kRgbd, uav::CameraKind::kSegmentation}) {
    World world = world_of_a_file();
    Sensor& sensor = world.uavs[1].sensors.at(0);
    std::get<CameraModel>(sensor.model).kind = kind;
    sensor.declared_at = {"uav.sdf", 17};
    const Error error = bad_file_error([&] { open_of(world); });
    EXPECT_EQ(error.subject(), sensor.name);
    EXPECT_EQ(error.where(), sensor.declared_at);
  }
}

TEST(OpenRequest, RefusesAnAntialiasedCameraAtTheKey) {
  World world = world_of_a_file();
  CameraModel& camera = std::get<CameraModel>(world.uavs[1].sensors.at(0).model);
  camera.antialias_at = {"profile.toml", 4};
  EXPECT_NO_THROW(open_of(world));
  camera.antialias = true;
  const Error error = bad_file_error([&] { open_of(world); });
  EXPECT_EQ(error.subject(), "antialias");
  EXPECT_EQ(error.where(), camera.antialias_at);
}

TEST(OpenRequest, NeedsAWorldWithAFile) {
  EXPECT_EQ(bad_file_error([] { open_of(busy_world()); }).subject(), "test");
}

}  // namespace
}  // namespace tether::sim
