#include "test_scenes.h"

#include <functional>
#include <limits>

#include <gmock/gmock.h>

#include <tether/base/error.h>
#include <tether/sim_raster/scene.h>

namespace tether::raster {
namespace {

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinite = std::numeric_limits<float>::infinity();

struct BadPart {
  const char* subject;
  std::function<void(SceneParts&)> spoil;
};

TEST(Scene, RefusesPartsThatCannotBeDrawnAndNamesThem) {
  const std::vector<BadPart> bad{
      {"mesh 0", [](SceneParts& p) { p.meshes[0].vertices[1].position[2] = kNotANumber; }},
      {"mesh 0", [](SceneParts& p) { p.meshes[0].vertices[1].position[2] = kInfinite; }},
      {"mesh 0", [](SceneParts& p) { p.meshes[0].vertices[0].position[0] = 2e6F; }},
      {"mesh 0", [](SceneParts& p) { p.meshes[0].vertices[1].normal[0] = kNotANumber; }},
      {"mesh 0", [](SceneParts& p) { p.meshes[0].vertices[0].uv[0] = kInfinite; }},
      {"mesh 1", [](SceneParts& p) { p.meshes[1].triangles[1][0] = 1'000'000; }},
      {"texture 0", [](SceneParts& p) { p.textures[0].width_px = 0; }},
      {"texture 0", [](SceneParts& p) { p.textures[0].width_px = 8193; }},
      {"texture 1", [](SceneParts& p) { p.textures[1].rgba.pop_back(); }},
      {"material 0", [](SceneParts& p) { p.materials[0].diffuse[0] = kNotANumber; }},
      {"material 0", [](SceneParts& p) { p.materials[0].alpha = 1.5F; }},
      {"material 0", [](SceneParts& p) { p.materials[0].shininess = -1.0F; }},
      {"material 0", [](SceneParts& p) { p.materials[0].texture = 2; }},
      {"visual 0", [](SceneParts& p) { p.instances[0].mesh = 9; }},
      {"visual 0", [](SceneParts& p) { p.instances[0].material = 9; }},
      {"visual 0", [](SceneParts& p) { p.instances[0].body = 1'000'000; }},
      {"visual 0", [](SceneParts& p) { p.instances[0].X_BV.p.x = 1e9; }},
      {"visual 0", [](SceneParts& p) { p.instances[0].X_BV.q.w = 0.5; }},
      {"light 1", [](SceneParts& p) { p.lights[1].diffuse[0] = -1.0F; }},
      {"light 1",
       [](SceneParts& p) {
         p.lights[1].direction_W = {0.0, 0.0, 0.0};
       }},
      {"light 1", [](SceneParts& p) { p.lights[1].attenuation_linear = kNotANumber; }},
      {"light 1", [](SceneParts& p) { p.lights[1].cast_shadows = true; }},
      {"light 2", [](SceneParts& p) { p.lights[2].spot_half_angle_rad = 2.0; }},
      {"scene", [](SceneParts& p) { p.ambient[0] = kNotANumber; }},
      {"scene", [](SceneParts& p) { p.lights.resize(kMaxLights + 1); }},
  };
  for (const BadPart& part : bad) {
    SceneParts parts = rich_parts();
    part.spoil(parts);
    try {
      const Scene scene(parts);
      ADD_FAILURE() << part.subject << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.subject(), part.subject) << error.what();
      EXPECT_EQ(error.code(), ErrorCode::kBadFile);
    }
  }
}

TEST(Scene, RefusesMoreTrianglesThanTheLimit) {
  SceneParts parts = rich_parts();
  const std::size_t each = parts.meshes[1].triangles.size();
  Instance one;
  one.mesh = 1;
  parts.instances.assign(kMaxTriangles / each + 1, one);
  EXPECT_THROW(Scene{parts}, Error);
}

TEST(Scene, AcceptsTrianglesWithoutAreaAndLeavesThemOut) {
  SceneParts parts = plain_parts(rectangle(-1, -1, 1, 1, 2), {1, 1, 1});
  parts.meshes[0].triangles = {{0, 0, 1}, {1, 1, 1}, {0, 1, 0}};
  const Drawing drawing = draw(Scene(parts), small_camera());
  EXPECT_THAT(drawing.entity, testing::Each(0U));
}

TEST(Scene, KnowsHowFarBodiesReach) {
  SceneParts parts = plain_parts(box(2.0F), {1, 1, 1});
  parts.instances[0].body = 1;
  parts.instances[0].X_BV.p = {3.0, 0.0, 0.0};
  const Scene scene(parts);
  ASSERT_EQ(scene.bodies(), 2U);
  EXPECT_EQ(scene.body_radii_m()[0], 0.0);
  EXPECT_NEAR(scene.body_radii_m()[1], 3.0 + std::sqrt(3.0), 1e-6);
}

}  // namespace
}  // namespace tether::raster
