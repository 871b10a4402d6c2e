#include "sdf_folder.h"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/sim/bodies.h>

namespace tether::sim {
namespace {

using std::numbers::pi;
using ::testing::IsEmpty;
using uav::Vec3;

const std::filesystem::path kSource = TETHER_SOURCE_DIR;

void expect_near(const Vec3& actual, const Vec3& expected, double tolerance = 1e-9) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
}

TEST(LoadWorld, PutsAModelWhereItsFrameSays) {
  const World world = load_content(R"(
      <frame name='table'><pose>1 2 3 0 0 1.5707963267948966</pose></frame>
      <model name='m'>
        <pose relative_to='table'>0.5 0 0 0 0 0</pose>
        <frame name='f'><pose>0 0 1 0 0 0</pose></frame>
        <link name='l'>
          <pose relative_to='f'>0 0.25 0 0 0 0</pose>
          <visual name='v'><pose relative_to='__model__'>0 0 2 0 0 0</pose>
            <geometry><sphere><radius>0.1</radius></sphere></geometry></visual>
        </link>
      </model>)")
                          .world;
  ASSERT_EQ(world.models.size(), 1u);
  const Model& model = world.models[0];
  expect_near(model.X_WM.p, {1.0, 2.5, 3.0});
  const uav::Pose X_WL = model.X_WM * model.links[0].X_ML;
  expect_near(X_WL.p, {0.75, 2.5, 4.0});
  expect_near((X_WL * model.links[0].visuals[0].X_LV).p, {1.0, 2.5, 5.0});
}

TEST(LoadWorld, PutsModelsWhereTheyWereWhenTheWorldWasSaved) {
  const Loaded loaded = load_content(R"(
      <model name='m'><pose>1 0 0 0 0 0</pose><link name='l'/>
        <model name='n'><pose>0 1 0 0 0 0</pose><link name='l'/></model></model>
      <model name='fell'><pose>1 0 0 0 0 0</pose><link name='l'/></model>
      <state world_name='w'>
        <model name='m'><pose>3 0 0 0 0 1.5707963267948966</pose><link name='l'/></model>
        <model name='fell'><pose>0 0 -1e9 0 0 0</pose></model>
        <model name='gone'><pose>0 0 0 0 0 0</pose></model></state>)");
  ASSERT_EQ(loaded.world.models.size(), 3u);
  expect_near(loaded.world.models[0].X_WM.p, {3.0, 0.0, 0.0});
  expect_near(loaded.world.models[1].X_WM.p, {2.0, 0.0, 0.0});
  expect_near(loaded.world.models[2].X_WM.p, {1.0, 0.0, 0.0});
}

TEST(LoadWorld, ReadsPhysicsAirSceneAndLights) {
  const Loaded loaded = load_content(R"(
      <physics name='p' type='ode'><max_step_size>0.002</max_step_size>
        <real_time_factor>1</real_time_factor></physics>
      <gravity>0 0 -1.62</gravity>
      <wind><linear_velocity>3 -1 0</linear_velocity></wind>
      <scene><ambient>0.25 0.25 0.25 1</ambient><background>0 0.5 1 1</background></scene>
      <light name='lamp' type='spot'><pose>1 2 3 0 0 0</pose><cast_shadows>true</cast_shadows>
        <diffuse>0.5 0.5 0.5 1</diffuse><intensity>0.5</intensity><direction>1 0 0</direction>
        <attenuation><range>1000</range><constant>0.5</constant><linear>0.25</linear>
          <quadratic>0.125</quadratic></attenuation>
        <spot><inner_angle>0</inner_angle><outer_angle>0.75</outer_angle><falloff>2</falloff></spot></light>
      <light name='sun' type='directional'/>)");
  EXPECT_THAT(loaded.warnings, IsEmpty());
  const World& world = loaded.world;
  EXPECT_EQ(world.step, std::chrono::milliseconds(2));
  EXPECT_EQ(world.wind, (uav::Wind{.v_WA_m_s = {3.0, -1.0, 0.0}}));
  EXPECT_EQ(world.step_from, "world");
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
  const World unshadowed = load_content(R"(<scene><shadows>false</shadows></scene>
      <light name='sun' type='directional'><cast_shadows>true</cast_shadows></light>)")
                               .world;
  EXPECT_FALSE(unshadowed.lights.at(0).cast_shadows);
}

TEST(LoadWorld, NestedModelsBecomeSeparateModels) {
  const World world = load_content(R"(
      <model name='outer'><static>true</static><pose>1 0 0 0 0 0</pose><link name='l'/>
        <model name='inner'><pose>0 2 0 0 0 0</pose><link name='l'/></model></model>)")
                          .world;
  ASSERT_EQ(world.models.size(), 2u);
  EXPECT_EQ(world.models[1].name, "outer::inner");
  EXPECT_EQ(world.models[1].X_WM.p, (Vec3{1, 2, 0}));
  EXPECT_TRUE(world.models[1].is_static);
}

TEST(LoadWorld, PlacesUavs) {
  const auto model = kSource / "data/models/hummingbird/model.sdf";
  const ScratchFolder folder;
  const auto file = folder.write("w.sdf", world_sdf(""));
  const World world =
      load({file, {{"a", model, {1, 2, 3}, 0.5 * pi}, {"b", model, {4, 5, 6}, 0.0}}, {}}).world;
  ASSERT_EQ(world.uavs.size(), 2u);
  EXPECT_EQ(world.uavs[0].name, "a");
  EXPECT_EQ(world.uavs[0].X_WB.p, (Vec3{1, 2, 3}));
  expect_near(uav::rotate(world.uavs[0].X_WB.q, {1, 0, 0}), {0, 1, 0});
  EXPECT_EQ(refusal({file, {{"a", model, {}}, {"a", model, {}}}, {}}).subject(), "a");
}

/// Models "m0", "m1", …, one a line, each of ten links.
std::string models_of_ten_links(std::size_t count, const std::string& name = "m",
                                const std::string& content = "") {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += "<model name='" + name + std::to_string(i) + "'>" + content;
    for (int k = 0; k < 10; ++k) text += "<link name='l" + std::to_string(k) + "'/>";
    text += "</model>\n";
  }
  return text;
}

TEST(LoadWorld, LimitsTheNumberOfMovingLinks) {
  constexpr std::size_t kModels = kMaxMovingLinks / 10;
  const auto most =
      models_of_ten_links(2, "s", "<static>true</static>") + models_of_ten_links(kModels);
  EXPECT_EQ(moving_bodies(load_content(most).world).size(), kMaxMovingLinks);
  const ScratchFolder folder;
  const auto file = folder.write("w.sdf", world_sdf(models_of_ten_links(kModels + 2)));
  expect_error(refusal({file, {}, {}}), file, 3 + kModels, "link 'l0'");
}

}  // namespace
}  // namespace tether::sim
