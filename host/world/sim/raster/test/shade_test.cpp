#include "shade/shade.h"

#include "place/lights.h"
#include "scene/trigonometry.h"
#include "shade/light_table.h"
#include "test_scenes.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

namespace tether::raster {
namespace {

using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::Ge;
using testing::Le;
using uav::Vec3;

// The middle pixel of a wall at z = 2 that fills the picture; its ray is the axis.
std::vector<int> wall(SceneParts parts) {
  return draw(Scene(parts), small_camera(33, 33)).at(16, 16);
}

// Opacities and colours are bytes when they are mixed.
auto IsAbout(int byte) {
  return AllOf(Ge(byte - 1), Le(byte + 1));
}

// Adds a visual with a material of its own.
void add(SceneParts& parts, const Mesh& mesh, const Material& material, const Vec3& p_WV = {}) {
  Instance one;
  one.mesh = parts.meshes.size();
  one.material = parts.materials.size();
  one.X_BV.p = p_WV;
  parts.meshes.push_back(mesh);
  parts.materials.push_back(material);
  parts.instances.push_back(one);
}

SceneParts dark_wall() {
  SceneParts parts = plain_parts(rectangle(-9, -9, 9, 9, 2), {0, 0, 0});
  parts.materials[0].diffuse = {1.0F, 0.5F, 0.25F};
  return parts;
}

Light head_light() {
  Light light;
  light.direction_W = {0.0, 0.0, 1.0};
  light.diffuse = {0.8F, 0.8F, 0.8F};
  return light;
}

TEST(Shade, AddsAmbientAndEmissive) {
  SceneParts parts = plain_parts(rectangle(-9, -9, 9, 9, 2), {0.2F, 0.4F, 0.6F});
  parts.ambient = {0.5F, 0.5F, 0.5F};
  parts.materials[0].emissive = {0.1F, 0.0F, 0.9F};
  EXPECT_THAT(wall(parts), ElementsAre(51, 51, 255));
}

TEST(Shade, LightsByTheCosine) {
  SceneParts parts = dark_wall();
  Light sun = head_light();
  sun.kind = LightKind::kDirectional;
  sun.direction_W = {std::sqrt(3.0), 0.0, 1.0};  // 60° off
  parts.lights = {sun};
  EXPECT_THAT(wall(parts), ElementsAre(102, 51, 26));
  parts.lights[0].direction_W = {0.0, 0.0, -1.0};
  EXPECT_THAT(wall(parts), Each(0));
}

TEST(Shade, AttenuatesByDistance) {
  SceneParts parts = dark_wall();
  Light lamp = head_light();
  lamp.attenuation_constant = 0.5F;
  lamp.attenuation_linear = 0.25F;
  lamp.attenuation_quadratic = 0.75F;
  parts.lights = {lamp};  // 1 / (0.5 + 0.5 + 3) of 0.8
  EXPECT_THAT(wall(parts), ElementsAre(51, 26, 13));
}

TEST(Shade, KeepsASpotWithinItsCone) {
  SceneParts parts = dark_wall();
  Light spot = head_light();
  spot.kind = LightKind::kSpot;
  spot.spot_half_angle_rad = 0.3;
  spot.spot_exponent = 2.0F;
  parts.lights = {spot};
  EXPECT_THAT(wall(parts), ElementsAre(204, 102, 51));
  parts.lights[0].direction_W = {std::sin(0.29), 0.0, std::cos(0.29)};
  const double fallen = std::cos(0.29) * std::cos(0.29);
  EXPECT_THAT(wall(parts)[0], std::lround(204 * fallen));
  parts.lights[0].direction_W = {std::sin(0.31), 0.0, std::cos(0.31)};
  EXPECT_THAT(wall(parts), Each(0));
}

TEST(Shade, ShinesWhereTheHalfOfLightAndViewIsNearTheNormal) {
  SceneParts parts = dark_wall();
  parts.materials[0].diffuse = {0.0F, 0.0F, 0.0F};
  parts.materials[0].specular = {0.5F, 1.0F, 0.0F};
  parts.materials[0].shininess = 32.0F;
  Light sun = head_light();
  sun.kind = LightKind::kDirectional;
  sun.specular = {1.0F, 1.0F, 1.0F};
  parts.lights = {sun};
  EXPECT_THAT(wall(parts), ElementsAre(128, 255, 0));
  parts.lights[0].direction_W = {std::sin(0.4), 0.0, std::cos(0.4)};
  EXPECT_NEAR(wall(parts)[1], 255 * std::pow(std::cos(0.2), 32.0), 1.0);
}

TEST(Shade, MixesWhatIsTransparentFromBackToFront) {
  SceneParts parts = plain_parts(rectangle(-9, -9, 9, 9, 4), {1.0F, 0.0F, 0.0F});
  const std::vector<Rgb> colours{{0.0F, 1.0F, 0.0F}, {0.0F, 0.0F, 1.0F}};
  // The nearer pane is given first, and both have corners of the same depth.
  for (std::size_t i = 0; i < 2; ++i) {
    Material pane = parts.materials[0];
    pane.ambient = colours[i];
    pane.alpha = 0.5F;
    add(parts, rectangle(-9, -9, 9, 9, i == 0 ? 2.0F : 3.0F), pane);
  }
  // Red, half blue: (½, 0, ½); half green: (¼, ½, ¼). Half of 255 is 128.
  EXPECT_THAT(wall(parts), ElementsAre(IsAbout(64), IsAbout(128), IsAbout(64)));
  const Drawing drawing = draw(Scene(parts), small_camera(33, 33));
  EXPECT_THAT(drawing.entity, Each(7U)) << "entities are those of opaque things";
}

TEST(Shade, ShowsTheNearest32TransparentSurfaces) {
  SceneParts parts = plain_parts(rectangle(-9, -9, 9, 9, 40), {0.0F, 0.0F, 0.0F});
  Material pane = parts.materials[0];
  pane.ambient = {1.0F, 1.0F, 1.0F};
  pane.alpha = 0.05F;
  for (int i = 0; i < 32; ++i) {
    add(parts, rectangle(-9, -9, 9, 9, 20.0F - 0.5F * static_cast<float>(i)), pane);
  }
  const std::vector<int> of_32 = wall(parts);
  EXPECT_NEAR(of_32[0], 255.0 * (1.0 - std::pow(0.95, 32)), 16.0) << "rounded 32 times";
  add(parts, rectangle(-9, -9, 9, 9, 30.0F), pane);
  EXPECT_EQ(wall(parts), of_32);
  pane.ambient = {0.0F, 0.0F, 0.0F};
  add(parts, rectangle(-9, -9, 9, 9, 1.0F), pane);
  EXPECT_LT(wall(parts)[0], of_32[0]) << "the nearest one is shown";
}

TEST(Shade, ShowsTheSidesBehindOfWhatIsTransparent) {
  SceneParts parts = plain_parts(rectangle(-9, -9, 9, 9, 4), {1.0F, 0.0F, 0.0F});
  Material glass = parts.materials[0];
  glass.ambient = {0.0F, 1.0F, 0.0F};
  glass.alpha = 0.5F;
  add(parts, box(1.0F), glass, {0.0, 0.0, 2.0});
  EXPECT_THAT(wall(parts), ElementsAre(IsAbout(64), IsAbout(191), 0));
}

TEST(Shade, ShowsTheUpperLeftPixelOfATextureAtItsUpperLeft) {
  SceneParts parts = plain_parts(rectangle(-1, -1, 1, 1, 2), {1.0F, 1.0F, 1.0F});
  parts.textures = {{2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255}}};
  parts.materials[0].texture = 0;
  uav::CameraModel camera = small_camera(64, 64);
  camera.fx_px = camera.fy_px = 64.0;  // the rectangle fills the picture
  const Drawing drawing = draw(Scene(parts), camera);
  // Half a pixel off the middles of the texture's pixels.
  const auto dark = Le(8);
  const auto bright = Ge(247);
  EXPECT_THAT(drawing.at(16, 16), ElementsAre(bright, dark, dark));
  EXPECT_THAT(drawing.at(47, 16), ElementsAre(dark, bright, dark));
  EXPECT_THAT(drawing.at(16, 47), ElementsAre(dark, dark, bright));
  EXPECT_THAT(drawing.at(47, 47), ElementsAre(bright, bright, bright));
}

// A texture's channel at a place, the slow way: bilinear on one size.
double texel(const PreparedScene& scene, std::size_t level, double u, double v,
             std::size_t channel) {
  const LevelRow& row = scene.levels[level];
  const double x = (u - std::floor(u)) * row.width_256ths / 256.0 - 0.5;
  const double y = (v - std::floor(v)) * row.height_256ths / 256.0 - 0.5;
  double sum = 0.0;
  for (int dy = 0; dy < 2; ++dy) {
    for (int dx = 0; dx < 2; ++dx) {
      const int column = static_cast<int>(std::floor(x)) + dx;
      const int line = static_cast<int>(std::floor(y));
      const int at = line * row.stride + column + row.first_pair;
      const double share = (dx == 0 ? 1.0 - (x - std::floor(x)) : x - std::floor(x)) *
                           (dy == 0 ? 1.0 - (y - std::floor(y)) : y - std::floor(y));
      const TexelPair& pair = scene.texels[static_cast<std::size_t>(at)];
      sum += share * (pair.channels[channel][static_cast<std::size_t>(dy)] + 128.0);
    }
  }
  return sum;
}

TEST(Shade, FiltersTexturesTrilinearly) {
  for (const float repeat : {0.37F, 2.3F, 9.0F, 21.0F}) {
    SceneParts parts = plain_parts(rectangle(-1, -1, 1, 1, 2, repeat), {1.0F, 1.0F, 1.0F});
    parts.textures = {noise(3, 24, 17)};
    parts.materials[0].texture = 0;
    const Scene scene(parts);
    uav::CameraModel camera = small_camera(64, 64);
    camera.fx_px = camera.fy_px = 64.0;
    const Drawing drawing = draw(scene, camera);
    const double lod = std::max(0.0, std::log2(repeat * 24 / 64.0));
    // The first size of all is that of the white texture.
    const auto level = static_cast<std::size_t>(lod) + 1;
    const std::size_t next = std::min(level + 1, scene.prepared().levels.size() - 2);
    for (int i = 0; i < 64 * 64; i += 7) {
      const double u = repeat * (i % 64 + 0.5) / 64.0;
      const double v = repeat * (static_cast<double>(i / 64) + 0.5) / 64.0;
      for (std::size_t channel = 0; channel < 3; ++channel) {
        const double a = texel(scene.prepared(), level, u, v, channel);
        const double b = texel(scene.prepared(), next, u, v, channel);
        const double expected = a + (b - a) * (lod + 1.0 - static_cast<double>(level));
        ASSERT_NEAR(drawing.at(i % 64, i / 64)[channel], expected, 2.0)
            << "repeated " << repeat << " times, pixel " << i;
      }
    }
  }
}

// Triangles of different looks share vectors of pixels, and the number of these differs from
// machine to machine: none may change the other's pixels.
TEST(Shade, KeepsPixelsFreeOfTheirNeighbours) {
  SceneParts parts = rich_parts();
  parts.meshes = {rectangle(-3.0F, -3.0F, 0.013F, 3.0F, 2.0F, 6.0F),
                  rectangle(0.013F, -3.0F, 3.0F, 3.0F, 2.5F, 6.0F)};
  parts.instances.resize(2);
  parts.instances[0].mesh = 0;
  parts.instances[1].mesh = 1;
  const auto draw_pair = [&](std::size_t left, std::size_t right) {
    parts.instances[0].material = left;
    parts.instances[1].material = right;
    return draw(Scene(parts), small_camera(160, 40));
  };
  for (const std::size_t left : {0U, 1U, 3U}) {
    const Drawing alike = draw_pair(left, left);
    for (const std::size_t right : {0U, 1U, 2U, 3U}) {
      const Drawing drawing = draw_pair(left, right);
      for (int i = 0; i < 40 * 80; ++i) {
        ASSERT_EQ(drawing.at(i % 80, i / 80), alike.at(i % 80, i / 80)) << left << ' ' << right;
      }
    }
  }
}

TEST(Shade, TakesHighlightsToAnyPower) {
  for (const float shininess : {0.0F, 0.75F, 1.0F, 2.5F, 10.0F, 33.125F}) {
    SceneParts parts = dark_wall();
    parts.materials[0].diffuse = {0.0F, 0.0F, 0.0F};
    parts.materials[0].specular = {1.0F, 1.0F, 1.0F};
    parts.materials[0].shininess = shininess;
    Light sun = head_light();
    sun.kind = LightKind::kDirectional;
    sun.direction_W = {std::sin(0.8), 0.0, std::cos(0.8)};
    sun.specular = {1.0F, 1.0F, 1.0F};
    parts.lights = {sun};
    EXPECT_NEAR(wall(parts)[0], 255 * std::pow(std::cos(0.4), shininess), 1.0) << shininess;
  }
}

TEST(Shade, AddsLightsOfOneAndOfSeveralColours) {
  SceneParts parts = dark_wall();
  parts.materials[0].diffuse = {1.0F, 1.0F, 1.0F};
  for (const Rgb& colour : {Rgb{0.1F, 0.1F, 0.0F}, Rgb{0.1F, 0.1F, 0.0F}, Rgb{0.0F, 0.2F, 0.4F}}) {
    parts.lights.push_back(head_light());
    parts.lights.back().diffuse = colour;
  }
  EXPECT_THAT(wall(parts), ElementsAre(51, 102, 102));
}

TEST(Shadows, DarkenWhatIsBehindTheirCaster) {
  for (const LightKind kind : {LightKind::kDirectional, LightKind::kSpot}) {
    SceneParts parts = dark_wall();
    parts.meshes.push_back(rectangle(0.3F, -0.5F, 1.3F, 0.5F, 1.5F));
    Instance screen = parts.instances[0];
    screen.mesh = 1;
    parts.instances.push_back(screen);
    Light light = head_light();
    light.kind = kind;
    light.p_WL = {2.0, 0.0, 0.0};
    light.direction_W = {-0.7, 0.0, 1.0};
    light.spot_half_angle_rad = 0.9;
    light.cast_shadows = true;
    parts.lights = {light};
    // The camera sees the wall left of the screen, where the screen's shadow falls: the light
    // comes from the right.
    const Drawing with = draw(Scene(parts), small_camera(65, 65));
    parts.instances[1].cast_shadows = false;
    const Drawing without = draw(Scene(parts), small_camera(65, 65));
    const auto column = [](double x) { return static_cast<int>(32 + 47.5 * x / 2.0); };
    const double shadow_x = kind == LightKind::kDirectional ? 0.15 : 0.0;
    EXPECT_EQ(with.at(column(shadow_x), 32)[0], 0) << static_cast<int>(kind);
    EXPECT_GT(without.at(column(shadow_x), 32)[0], 60) << static_cast<int>(kind);
    EXPECT_EQ(with.at(column(-0.9), 32), without.at(column(-0.9), 32)) << static_cast<int>(kind);
  }
}

// A screen of 0.2 m before a wall of 100 m, far from a block. The sun comes from the right.
TEST(Shadows, AreSharpInALargeWorld) {
  for (const bool is_body : {false, true}) {
    SceneParts parts = dark_wall();
    parts.meshes = {rectangle(-50.0F, -50.0F, 50.0F, 50.0F, 2.0F),
                    rectangle(0.25F, -0.1F, 0.45F, 0.1F, 1.5F), box(1.0F)};
    const Instance wall = parts.instances[0];
    parts.instances = {wall, wall, wall};
    parts.instances[1].mesh = 1;
    if (is_body) parts.instances[1].body = 0;
    parts.instances[2].mesh = 2;
    parts.instances[2].X_BV.p = {is_body ? -40.0 : -4.0, 0.0, 1.5};
    Light sun = head_light();
    sun.kind = LightKind::kDirectional;
    sun.direction_W = {-0.7, 0.0, 1.0};
    sun.cast_shadows = true;
    parts.lights = {sun};
    const Drawing drawing = draw(Scene(parts), small_camera(640, 480));
    int dark = 0;
    for (int i = 0; i < 360; ++i) dark += drawing.at(i, 240)[0] < 50 ? 1 : 0;
    EXPECT_NEAR(dark, 0.2 * 467.7 / 2.0, 3.0) << is_body;
  }
}

// A floor under a light at a small angle: each row of the picture is a row of the floor.
TEST(Shadows, FallOnNoSurfaceThatCastsThemItself) {
  for (const LightKind kind : {LightKind::kDirectional, LightKind::kSpot}) {
    for (const double elevation_rad : {0.06, 0.1, 0.3, 0.8, 1.5}) {
      Mesh floor = rectangle(-20.0F, -20.0F, 20.0F, 20.0F, 0.0F);
      SceneParts parts = dark_wall();
      parts.meshes = {floor};
      parts.materials[0].diffuse = {1.0F, 1.0F, 1.0F};
      parts.instances[0].X_BV = {{0.0, 1.0, 0.0}, uav::from_axis_angle({1.0, 0.0, 0.0}, -1.6)};
      Light light = head_light();
      light.kind = kind;
      light.direction_W = {std::cos(elevation_rad), std::sin(elevation_rad), 0.0};
      light.p_WL = Vec3{0.0, 1.0, 5.0} - 10.0 * light.direction_W;
      light.spot_half_angle_rad = 0.9;
      parts.lights = {light};
      const Drawing without = draw(Scene(parts), small_camera());
      ASSERT_GT(without.at(80, 100)[0], 0) << static_cast<int>(kind) << ' ' << elevation_rad;
      parts.lights[0].cast_shadows = true;
      const Drawing with = draw(Scene(parts), small_camera());
      EXPECT_EQ(with.rgb, without.rgb) << static_cast<int>(kind) << ' ' << elevation_rad;
    }
  }
}

TEST(LightTable, GivesBytesBack) {
  const LightTable& table = light_table();
  for (std::size_t i = 0; i < 256; ++i) {
    const double srgb = static_cast<double>(i) / 255.0;
    const double light = srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(table.light[i], 65535.0 * light, 0.01);
    EXPECT_EQ(table.byte[static_cast<std::size_t>(std::lround(table.light[i]))], i);
  }
}

TEST(Trigonometry, AgreesWithTheStandardLibrary) {
  for (double angle = 0.0; angle <= 0.5 * std::numbers::pi; angle += 0.01) {
    EXPECT_NEAR(sine(angle), std::sin(angle), 1e-15);
    EXPECT_NEAR(cosine(angle), std::cos(angle), 1e-15);
  }
}

}  // namespace
}  // namespace tether::raster
