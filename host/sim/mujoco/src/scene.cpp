// Converts a World into the renderer's scene: a mesh, a material and an instance for each visual,
// lights, and textures. Files that several visuals name are read once.

#include "scene.h"

#include "mesh_file.h"
#include "texture_file.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include <tether/sim/bodies.h>

namespace tether::sim {
namespace {

using uav::Pose;
using uav::Vec3;

constexpr float kShininess = 32.0F;

raster::Rgb rgb(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

class SceneBuilder {
 public:
  explicit SceneBuilder(const WarningSink& warn) : warn_(warn) {}

  void add_link(const Link& link, const Pose& X, std::optional<std::size_t> body,
                std::uint32_t entity) {
    for (const Visual& visual : link.visuals) {
      raster::Instance instance;
      instance.mesh = mesh_of(visual);
      instance.material = parts_.materials.size();
      instance.body = body;
      instance.X_BV = X * visual.X_LV;
      instance.cast_shadows = visual.cast_shadows;
      instance.entity = entity;
      parts_.materials.push_back(material_of(visual.material));
      parts_.instances.push_back(instance);
    }
  }

  void add_light(const Light& in) {
    if (parts_.lights.size() == raster::kMaxLights) {
      warn_({Consequence::kLooksDifferent,
             {},
             fmt::format("light '{}'", in.name),
             fmt::format("is not shown: at most {} lights are", raster::kMaxLights)});
      return;
    }
    raster::Light light;
    light.kind = static_cast<raster::LightKind>(in.kind);
    light.p_WL = in.X_WL.p;
    const Vec3 direction_W = rotate(in.X_WL.q, in.direction);
    if (norm(direction_W) > 0.0) light.direction_W = direction_W;
    light.diffuse = rgb(in.diffuse_rgb);
    light.specular = rgb(in.specular_rgb);
    light.attenuation_constant = static_cast<float>(in.attenuation_constant);
    light.attenuation_linear = static_cast<float>(in.attenuation_linear);
    light.attenuation_quadratic = static_cast<float>(in.attenuation_quadratic);
    light.spot_half_angle_rad =
        std::clamp(0.5 * in.spot_outer_angle_rad, 0.0, 0.5 * std::numbers::pi);
    light.spot_exponent = static_cast<float>(std::clamp(in.spot_falloff, 0.0, 128.0));
    light.cast_shadows = in.cast_shadows;
    parts_.lights.push_back(light);
  }

  raster::SceneParts take() { return std::move(parts_); }

 private:
  std::size_t mesh_of(const Visual& visual) {
    const TextureScale scale{visual.material.texture_repeat_x, visual.material.texture_repeat_y};
    const auto add = [&](raster::Mesh mesh) {
      parts_.meshes.push_back(std::move(mesh));
      return parts_.meshes.size() - 1;
    };
    return std::visit(
        Visitor{
            [&](const BoxGeometry& g) { return add(box_mesh(g.size_m, scale)); },
            [&](const CylinderGeometry& g) {
              return add(cylinder_mesh(g.radius_m, g.length_m, scale));
            },
            [&](const SphereGeometry& g) {
              return add(ellipsoid_mesh({g.radius_m, g.radius_m, g.radius_m}, scale));
            },
            [&](const CapsuleGeometry& g) {
              return add(capsule_mesh(g.radius_m, g.length_m, scale));
            },
            [&](const EllipsoidGeometry& g) { return add(ellipsoid_mesh(g.radii_m, scale)); },
            [&](const PlaneGeometry& g) { return add(plane_mesh(g, scale)); },
            [&](const MeshGeometry& g) {
              const std::tuple key{g.file,
                                   g.submesh,
                                   g.scale.x,
                                   g.scale.y,
                                   g.scale.z,
                                   scale.repeat_x_per_m,
                                   scale.repeat_y_per_m};
              const auto [known, is_new] = mesh_files_.try_emplace(key);
              if (is_new) known->second = add(load_mesh(g, scale, warn_));
              return known->second;
            },
        },
        visual.geometry);
  }

  raster::Material material_of(const Material& in) {
    raster::Material material;
    material.ambient = rgb(in.ambient_rgb);
    material.diffuse = rgb(in.diffuse_rgb);
    material.specular = rgb(in.specular_rgb);
    material.emissive = rgb(in.emissive_rgb);
    material.alpha = static_cast<float>(in.alpha);
    material.shininess = kShininess;
    material.texture = texture_of(in.albedo_map);
    return material;
  }

  std::optional<std::size_t> texture_of(const std::filesystem::path& file) {
    if (file.empty()) return std::nullopt;
    const auto [known, is_new] = textures_.try_emplace(file);
    if (!is_new) return known->second;
    known->second = parts_.textures.size();
    parts_.textures.push_back(load_texture(file));
    return known->second;
  }

  const WarningSink& warn_;
  raster::SceneParts parts_;
  std::map<std::tuple<std::filesystem::path, std::string, double, double, double, double, double>,
           std::size_t>
      mesh_files_;
  std::map<std::filesystem::path, std::optional<std::size_t>> textures_;
};

}  // namespace

raster::SceneParts make_scene(const World& world, const WarningSink& warn) {
  SceneBuilder builder(warn);
  const auto number_of = [&](const Model* model) {
    return static_cast<std::uint32_t>(model - world.models.data()) + 1;
  };
  for (const FixedBody& body : fixed_bodies(world)) {
    builder.add_link(*body.link, body.X_WB, std::nullopt, number_of(body.model));
  }
  const std::vector<MovingBody> moving = moving_bodies(world);
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const auto uav = static_cast<std::uint32_t>(world.models.size() + i) + 1;
    builder.add_link(*moving[i].link, {}, i, moving[i].uav ? uav : number_of(moving[i].model));
  }
  for (const Light& light : world.lights) builder.add_light(light);
  raster::SceneParts parts = builder.take();
  parts.ambient = rgb(world.ambient_rgb);
  parts.background = rgb(world.background_rgb);
  return parts;
}

}  // namespace tether::sim
