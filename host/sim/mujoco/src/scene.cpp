// Converts a World into the renderer's Scene: one item with a mesh for each visual, lights, and
// textures. Warns of everything that OpenGL's fixed lights and MuJoCo's renderer cannot show.
// `make_scene_model` makes the engine model that allocates the textures and display lists.

#include "scene.h"

#include "conversions.h"
#include "mesh_file.h"
#include "texture_file.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include <fmt/format.h>

#include <tether/base/units.h>

namespace tether::sim {
namespace {

using uav::Pose;
using uav::Vec3;

constexpr std::size_t kMaxLights = 8;     // OpenGL's guaranteed number
constexpr std::size_t kMaxTextures = 99;  // the engine keeps 100; the sky takes one
constexpr int kSamples = 0;               // beyond one per pixel: smoother edges at twice the time
constexpr float kShininess = 0.25F;
constexpr double kVisibleDifference = 0.05;

double largest(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// The factor on the diffuse colour that comes nearest to the emissive one.
double emission_factor(const Material& material) {
  const double norm2 = dot(material.diffuse_rgb, material.diffuse_rgb);
  return norm2 > 0.0 ? dot(material.emissive_rgb, material.diffuse_rgb) / norm2 : 0.0;
}

// Builds the scene's items from the world's links.
class SceneBuilder {
 public:
  SceneBuilder(Scene& scene, const WarningSink& warn) : scene_(scene), warn_(warn) {}

  void add_link(const Link& link, const Pose& X, std::optional<std::size_t> body) {
    for (const Visual& visual : link.visuals) {
      check_colors(visual);
      SceneItem item;
      item.geom = make_geom(visual.material);
      item.geom.dataid = mesh_list(scene_.meshes.size());
      item.body = body;
      item.X_BV = X * visual.X_LV;
      scene_.meshes.push_back(mesh_of(visual));
      item.bounds = bounding_sphere(scene_.meshes.back());
      item.geom.modelrbound = static_cast<float>(item.bounds.radius_m);
      scene_.items.push_back(item);
    }
  }

 private:
  TriangleMesh mesh_of(const Visual& visual) const {
    const TextureScale scale{visual.material.texture_repeat_x, visual.material.texture_repeat_y};
    return std::visit(
        Visitor{
            [&](const BoxGeometry& g) { return box_mesh(g.size_m, scale); },
            [&](const CylinderGeometry& g) { return cylinder_mesh(g.radius_m, g.length_m, scale); },
            [&](const SphereGeometry& g) {
              return ellipsoid_mesh({g.radius_m, g.radius_m, g.radius_m}, scale);
            },
            [&](const CapsuleGeometry& g) { return capsule_mesh(g.radius_m, g.length_m, scale); },
            [&](const EllipsoidGeometry& g) { return ellipsoid_mesh(g.radii_m, scale); },
            [&](const PlaneGeometry& g) { return plane_mesh(g, scale); },
            [&](const MeshGeometry& g) { return load_mesh(g, scale, warn_); },
        },
        visual.geometry);
  }

  mjvGeom make_geom(const Material& material) {
    mjvGeom geom{};
    geom.type = mjGEOM_MESH;
    geom.objtype = mjOBJ_UNKNOWN;
    geom.objid = -1;
    geom.segid = -1;
    geom.category = mjCAT_STATIC;
    geom.texid = texture(material.albedo_map);
    geom.texcoord = geom.texid >= 0 ? 1 : 0;
    copy_to(material.diffuse_rgb, geom.rgba);
    geom.rgba[3] = static_cast<float>(material.alpha);
    const Vec3& s = material.specular_rgb;
    geom.specular = static_cast<float>((s.x + s.y + s.z) / 3.0);
    geom.shininess = kShininess;
    geom.emission = static_cast<float>(emission_factor(material));
    return geom;
  }

  // −1: none.
  int texture(const std::filesystem::path& file) {
    if (file.empty()) return -1;
    auto& textures = scene_.textures;
    const auto found = std::find(textures.begin(), textures.end(), file);
    if (found != textures.end()) return static_cast<int>(found - textures.begin());
    if (textures.size() == kMaxTextures) {
      warn_({Consequence::kLooksDifferent,
             {file.string()},
             "texture",
             fmt::format("is not shown: there are more than {}", kMaxTextures)});
      return -1;
    }
    textures.push_back(file);
    return static_cast<int>(textures.size()) - 1;
  }

  void warn_about(const Visual& visual, const char* message) const {
    warn_({Consequence::kLooksDifferent, {}, fmt::format("visual '{}'", visual.name), message});
  }

  void check_colors(const Visual& visual) const {
    const Material& m = visual.material;
    if (largest(m.ambient_rgb - m.diffuse_rgb) > kVisibleDifference) {
      warn_about(visual, "has an ambient colour that is not shown; the diffuse one is used");
    }
    const double grey = (m.specular_rgb.x + m.specular_rgb.y + m.specular_rgb.z) / 3.0;
    if (largest(m.specular_rgb - Vec3{grey, grey, grey}) > kVisibleDifference) {
      warn_about(visual, "has a specular colour that is shown as grey");
    }
    if (largest(m.emissive_rgb - emission_factor(m) * m.diffuse_rgb) > kVisibleDifference) {
      warn_about(visual, "has an emissive colour that is shown in the diffuse colour's hue");
    }
  }

  Scene& scene_;
  const WarningSink& warn_;
};

mjvLight ambient_light(const Vec3& rgb) {
  mjvLight light{};
  light.directional = 1;
  light.dir[2] = -1.0F;
  copy_to(rgb, light.ambient);
  return light;
}

mjvLight make_light(const Light& in) {
  mjvLight light{};
  copy_to(in.X_WL.p, light.pos);
  const Vec3 direction = rotate(in.X_WL.q, in.direction);
  const double length = norm(direction);
  copy_to(length > 0.0 ? (1.0 / length) * direction : Vec3{0.0, 0.0, -1.0}, light.dir);
  copy_to(Vec3{in.attenuation_constant, in.attenuation_linear, in.attenuation_quadratic},
          light.attenuation);
  copy_to(in.diffuse_rgb, light.diffuse);
  copy_to(in.specular_rgb, light.specular);
  light.directional = in.kind == LightKind::kDirectional ? 1 : 0;
  light.castshadow = in.cast_shadows ? 1 : 0;
  light.cutoff = 180.0F;
  if (in.kind == LightKind::kSpot) {
    const double half_rad = std::clamp(0.5 * in.spot_outer_angle_rad, 0.0, 0.5 * std::numbers::pi);
    light.cutoff = static_cast<float>(deg_from_rad(half_rad));
    light.exponent = static_cast<float>(std::clamp(in.spot_falloff, 0.0, 128.0));
  }
  return light;
}

void add_lights(Scene& scene, const World& world, const WarningSink& warn) {
  scene.lights.push_back(ambient_light(world.ambient_rgb));
  for (const Light& light : world.lights) {
    if (scene.lights.size() == kMaxLights) {
      warn({Consequence::kLooksDifferent,
            {},
            fmt::format("light '{}'", light.name),
            fmt::format("is not shown: at most {} lights are", kMaxLights - 1)});
      continue;
    }
    scene.lights.push_back(make_light(light));
    scene.shadows = scene.shadows || light.cast_shadows;
  }
}

void warn_about_shadows(const Link& link, const WarningSink& warn) {
  for (const Visual& visual : link.visuals) {
    if (visual.cast_shadows) continue;
    warn({Consequence::kLooksDifferent,
          {},
          fmt::format("visual '{}'", visual.name),
          "casts a shadow in spite of its <cast_shadows>"});
  }
}

}  // namespace

Scene make_scene(const World& world, const WarningSink& warn) {
  Scene scene;
  scene.background_rgb = world.background_rgb;
  SceneBuilder builder(scene, warn);
  for (const FixedBody& body : fixed_bodies(world)) {
    builder.add_link(*body.link, body.X_WB, std::nullopt);
  }
  const std::vector<MovingBody> moving = moving_bodies(world);
  for (std::size_t i = 0; i < moving.size(); ++i) builder.add_link(*moving[i].link, {}, i);
  add_lights(scene, world, warn);
  if (scene.shadows) {
    for (const FixedBody& body : fixed_bodies(world)) warn_about_shadows(*body.link, warn);
    for (const MovingBody& body : moving) warn_about_shadows(*body.link, warn);
  }
  return scene;
}

std::vector<double> body_radii_m(const Scene& scene, std::size_t bodies) {
  std::vector<double> radii_m(bodies, 0.0);
  for (const SceneItem& item : scene.items) {
    if (!item.body) continue;
    double& radius_m = radii_m[*item.body];
    const double reach_m = norm(transform(item.X_BV, item.bounds.centre)) + item.bounds.radius_m;
    radius_m = std::max(radius_m, reach_m);
  }
  return radii_m;
}

ModelPtr make_scene_model(const Scene& scene, int width_px, int height_px) {
  std::string assets;
  std::vector<ModelFile> files;
  for (const std::filesystem::path& file : scene.textures) {
    files.push_back(texture_file(fmt::format("t{}", files.size()), file));
    assets += fmt::format(R"(<texture type="2d" name="{0}" file="{0}"/>)", files.back().name);
  }
  // The background is a sky of one colour, after the textures that items count.
  const Vec3& sky = scene.background_rgb;
  assets += fmt::format(R"(<texture name="sky" type="skybox" builtin="flat" width="8" height="8" )"
                        R"(rgb1="{0} {1} {2}" rgb2="{0} {1} {2}"/>)",
                        sky.x, sky.y, sky.z);
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    assets += fmt::format(R"(<mesh name="m{}" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/>)", i);
  }
  const std::string xml = fmt::format(
      R"(<mujoco><visual><global offwidth="{}" offheight="{}"/>)"
      R"(<quality offsamples="{}" shadowsize="{}" numslices="8" numstacks="4" numquads="1"/>)"
      "</visual><asset>{}</asset><worldbody/></mujoco>",
      width_px, height_px, kSamples, scene.shadows ? 2048 : 0, assets);
  return compile_model(xml, files);
}

}  // namespace tether::sim
