#include "test_scenes.h"

#include <bit>
#include <cmath>
#include <numbers>

#include <tether/base/random.h>

namespace tether::raster {
namespace {

void add_square(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
}

// Of a grid of (n + 1)² vertices, row after row.
void add_squares(Mesh& mesh, int n) {
  const auto stride = static_cast<std::uint32_t>(n + 1);
  for (std::uint32_t i = 0; i + 1 < stride; ++i) {
    for (std::uint32_t j = 0; j + 1 < stride; ++j) {
      const std::uint32_t a = i * stride + j;
      add_square(mesh, a, a + stride, a + stride + 1, a + 1);
    }
  }
}

std::uint32_t count(const Mesh& mesh) {
  return static_cast<std::uint32_t>(mesh.vertices.size());
}

void add_vertex(Mesh& mesh, float x, float y, float z, const std::array<float, 3>& n, float u,
                float v) {
  mesh.vertices.push_back({{x, y, z}, n, {u, v}});
}

Instance instance(std::size_t mesh, std::size_t material, const uav::Vec3& p, std::uint32_t id) {
  Instance i;
  i.mesh = mesh;
  i.material = material;
  i.X_BV = {p, uav::from_axis_angle({0.0, 1.0, 0.0}, 0.3 * id)};
  i.entity = id;
  return i;
}

}  // namespace

double drawn(std::uint64_t seed, std::uint64_t index, double low, double high) {
  std::uint64_t x = (seed + 1) * 0x9E3779B97F4A7C15ULL + index * 0xD1B54A32D192ED03ULL;
  for (int i = 0; i < 3; ++i) {
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    x ^= x >> 27U;
  }
  return low + (high - low) * static_cast<double>(x >> 11U) * 0x1p-53;
}

Mesh rectangle(float left, float top, float right, float bottom, float z, float repeat) {
  Mesh mesh;
  const std::array<float, 3> n{0.0F, 0.0F, -1.0F};
  add_vertex(mesh, left, top, z, n, 0.0F, 0.0F);
  add_vertex(mesh, left, bottom, z, n, 0.0F, repeat);
  add_vertex(mesh, right, bottom, z, n, repeat, repeat);
  add_vertex(mesh, right, top, z, n, repeat, 0.0F);
  add_square(mesh, 0, 1, 2, 3);
  return mesh;
}

Mesh box(float size) {
  Mesh mesh;
  const float h = 0.5F * size;
  for (int face = 0; face < 6; ++face) {
    const auto axis = static_cast<std::size_t>(face / 2);
    const float side = face % 2 == 0 ? 1.0F : -1.0F;
    std::array<float, 3> n{};
    n[axis] = side;
    const std::uint32_t first = count(mesh);
    for (int corner = 0; corner < 4; ++corner) {
      const float a = corner == 0 || corner == 3 ? -h : h;
      const float b = corner < 2 ? -h : h;
      std::array<float, 3> p{};
      p[axis] = side * h;
      p[(axis + 1) % 3] = side * a;
      p[(axis + 2) % 3] = b;
      add_vertex(mesh, p[0], p[1], p[2], n, a / size + 0.5F, b / size + 0.5F);
    }
    add_square(mesh, first, first + 1, first + 2, first + 3);
  }
  return mesh;
}

Mesh ball(float radius, int n) {
  Mesh mesh;
  for (int i = 0; i <= n; ++i) {
    const double polar = std::numbers::pi * i / n;
    for (int j = 0; j <= n; ++j) {
      const double around = 2.0 * std::numbers::pi * j / n;
      const std::array<float, 3> p{static_cast<float>(std::sin(polar) * std::cos(around)),
                                   static_cast<float>(std::sin(polar) * std::sin(around)),
                                   static_cast<float>(std::cos(polar))};
      add_vertex(mesh, radius * p[0], radius * p[1], radius * p[2], p,
                 static_cast<float>(j) / static_cast<float>(n),
                 static_cast<float>(i) / static_cast<float>(n));
    }
  }
  add_squares(mesh, n);
  return mesh;
}

Mesh crumpled_sheet(std::uint64_t seed, int n, float z) {
  Mesh mesh;
  const float step = 4.0F * z / static_cast<float>(n);
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const auto key = static_cast<std::uint64_t>(3 * (i * (n + 1) + j));
      const auto moved = [&](std::uint64_t k, float most) {
        return static_cast<float>(drawn(seed, key + k, -most, most));
      };
      add_vertex(mesh, -2.0F * z + step * (static_cast<float>(j) + moved(0, 0.2F)),
                 -2.0F * z + step * (static_cast<float>(i) + moved(1, 0.2F)),
                 z * (1.0F + moved(2, 0.002F)), {0.0F, 0.0F, -1.0F}, 0.0F, 0.0F);
    }
  }
  add_squares(mesh, n);
  return mesh;
}

Texture noise(std::uint64_t seed, int width_px, int height_px) {
  Texture texture{width_px, height_px, {}};
  const auto bytes = static_cast<std::uint64_t>(4 * width_px * height_px);
  for (std::uint64_t i = 0; i < bytes; ++i) {
    texture.rgba.push_back(i % 4 == 3 ? 255 : static_cast<std::uint8_t>(drawn(seed, i, 0, 256)));
  }
  return texture;
}

SceneParts plain_parts(Mesh mesh, const Rgb& colour) {
  SceneParts parts;
  parts.ambient = {1.0F, 1.0F, 1.0F};
  parts.background = {0.0F, 0.0F, 0.0F};
  parts.meshes.push_back(std::move(mesh));
  Material material;
  material.ambient = colour;
  material.diffuse = {0.0F, 0.0F, 0.0F};
  parts.materials.push_back(material);
  Instance one;
  one.entity = 7;
  parts.instances.push_back(one);
  return parts;
}

SceneParts rich_parts() {
  SceneParts parts;
  parts.textures = {noise(1, 64, 64), noise(2, 37, 21)};
  parts.meshes = {box(1.0F), ball(0.6F, 16), rectangle(-3.0F, -3.0F, 3.0F, 3.0F, 8.0F, 6.0F)};
  Material wood;
  wood.texture = 0;
  Material shiny;
  shiny.diffuse = {0.2F, 0.5F, 0.9F};
  shiny.specular = {0.7F, 0.7F, 0.7F};
  Material glass = shiny;
  glass.alpha = 0.4F;
  Material glowing;
  glowing.emissive = {0.3F, 0.1F, 0.0F};
  glowing.texture = 1;
  parts.materials = {wood, shiny, glass, glowing};
  parts.instances = {instance(2, 0, {0.0, 0.0, 0.0}, 0),  instance(0, 3, {-1.2, 0.3, 4.0}, 1),
                     instance(1, 1, {0.9, -0.4, 4.5}, 2), instance(0, 2, {0.4, 0.5, 3.0}, 3),
                     instance(1, 2, {0.7, 0.2, 2.5}, 4),  instance(0, 0, {-0.6, -0.8, 3.5}, 5)};
  parts.instances[5].body = 0;
  Light sun;
  sun.kind = LightKind::kDirectional;
  sun.direction_W = {0.3, 0.6, 1.0};
  sun.diffuse = {0.5F, 0.5F, 0.45F};
  sun.cast_shadows = true;
  Light lamp;
  lamp.p_WL = {1.0, -1.0, 1.5};
  lamp.specular = {0.5F, 0.5F, 0.5F};
  lamp.attenuation_quadratic = 0.1F;
  Light spot = lamp;
  spot.kind = LightKind::kSpot;
  spot.p_WL = {-1.0, -1.0, 0.0};
  spot.direction_W = {0.1, 0.2, 1.0};
  spot.spot_exponent = 1.5F;
  parts.lights = {sun, lamp, spot};
  return parts;
}

std::vector<int> Drawing::at(int column, int row) const {
  const auto i = static_cast<std::size_t>(3 * (row * width_px + column));
  return {rgb[i], rgb[i + 1], rgb[i + 2]};
}

Drawing draw(Renderer& renderer, const View& view) {
  const auto pixels = static_cast<std::size_t>(view.camera.width_px * view.camera.height_px);
  Drawing drawing{view.camera.width_px, std::vector<std::uint8_t>(3 * pixels),
                  std::vector<float>(pixels), std::vector<std::uint32_t>(pixels)};
  Picture picture;
  picture.rgb = drawing.rgb;
  picture.depth_m = drawing.depth_m;
  picture.entity = drawing.entity;
  renderer.draw(view, picture);
  return drawing;
}

Drawing draw(const Scene& scene, const uav::CameraModel& camera, const uav::Pose& X_WC) {
  Renderer renderer(scene);
  const std::vector<uav::Pose> bodies(scene.bodies());
  const Instant instant{X_WC, bodies};
  View view;
  view.camera = camera;
  view.instants = {&instant, 1};
  return draw(renderer, view);
}

std::uint64_t hash_of(const Drawing& drawing) {
  std::uint64_t hash = 1469598103934665603ULL;
  const auto add = [&](std::uint32_t v) { hash = (hash ^ v) * 1099511628211ULL; };
  for (const std::uint8_t byte : drawing.rgb) add(byte);
  for (const float depth : drawing.depth_m) add(std::bit_cast<std::uint32_t>(depth));
  for (const std::uint32_t entity : drawing.entity) add(entity);
  return hash;
}

uav::CameraModel small_camera(int width_px, int height_px) {
  return uav::CameraModel::from_horizontal_fov(width_px, height_px, 1.2);
}

uav::CameraModel bent_camera(int width_px, int height_px) {
  uav::CameraModel camera = small_camera(width_px, height_px);
  camera.k1 = -0.2;
  camera.k2 = 0.03;
  camera.p1 = 0.002;
  camera.p2 = -0.001;
  return camera;
}

}  // namespace tether::raster
