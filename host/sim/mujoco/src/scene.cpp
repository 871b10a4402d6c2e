// Converts a World into the renderer's scene: a mesh, a material and an instance for each visual,
// lights, and textures. Files that several visuals name are read once.

#include "scene.h"

#include "named_file.h"
#include "texture_file.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include <tether/base/error.h>
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
  SceneBuilder(const MeshFiles& mesh_files, const WarningSink& warn)
      : mesh_files_(mesh_files), warn_(warn) {}

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
    light.attenuation_constant = factor(in.attenuation_constant);
    light.attenuation_linear = factor(in.attenuation_linear);
    light.attenuation_quadratic = factor(in.attenuation_quadratic);
    if (in.attenuation_constant + in.attenuation_linear + in.attenuation_quadratic <= 0.0) {
      light.attenuation_constant = 1.0F;
    }
    light.spot_half_angle_rad = 0.5 * in.spot_outer_angle_rad;
    light.spot_exponent = static_cast<float>(std::clamp(in.spot_falloff, 0.0, 128.0));
    light.cast_shadows = in.cast_shadows && in.kind != LightKind::kPoint;
    if (in.cast_shadows && !light.cast_shadows) {
      warn_({Consequence::kLooksDifferent,
             {},
             fmt::format("light '{}'", in.name),
             "casts no shadows: only directional and spot lights do"});
    }
    parts_.lights.push_back(light);
  }

  raster::SceneParts take() { return std::move(parts_); }

 private:
  static float factor(double attenuation) { return static_cast<float>(std::min(attenuation, 1e6)); }

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
              const std::tuple key{key_of(g), scale.repeat_x_per_m, scale.repeat_y_per_m};
              return read_named(g.named_at, [&] {
                const auto [known, is_new] = meshes_.try_emplace(key);
                if (is_new) known->second = add(mesh_files_.load(g, scale, warn_));
                count_triangles(g, parts_.meshes[known->second]);
                return known->second;
              });
            },
        },
        visual.geometry);
  }

  // Stops before the next file fills the memory.
  void count_triangles(const MeshGeometry& geometry, const raster::Mesh& mesh) {
    triangles_ += mesh.triangles.size();
    if (triangles_ > raster::kMaxTriangles) {
      throw Error(ErrorCode::kBadFile, FileLocation{geometry.file.string()},
                  "brings the world to more than 10,000,000 triangles");
    }
  }

  raster::Material material_of(const Material& in) {
    raster::Material material;
    material.ambient = rgb(in.ambient_rgb);
    material.diffuse = rgb(in.diffuse_rgb);
    material.specular = rgb(in.specular_rgb);
    material.emissive = rgb(in.emissive_rgb);
    material.alpha = static_cast<float>(in.alpha);
    material.shininess = kShininess;
    if (!in.albedo_map.empty()) {
      read_named(in.albedo_map_at, [&] { material.texture = texture_of(in.albedo_map); });
    }
    return material;
  }

  std::size_t texture_of(const std::filesystem::path& file) {
    const auto [known, is_new] = textures_.try_emplace(file);
    if (!is_new) return known->second;
    known->second = parts_.textures.size();
    parts_.textures.push_back(load_texture(file, warn_));
    texels_ += parts_.textures.back().rgba.size() / 4;
    if (texels_ > raster::kMaxTexels) {
      throw Error(ErrorCode::kBadFile, FileLocation{file.string()},
                  "brings the world's textures to more than 67,108,864 pixels");
    }
    return known->second;
  }

  const MeshFiles& mesh_files_;
  const WarningSink& warn_;
  raster::SceneParts parts_;
  std::size_t triangles_ = 0;
  std::size_t texels_ = 0;
  std::map<std::tuple<MeshKey, double, double>, std::size_t> meshes_;
  std::map<std::filesystem::path, std::size_t> textures_;
};

}  // namespace

raster::SceneParts make_scene(const World& world, const WarningSink& warn,
                              const MeshFiles& meshes) {
  SceneBuilder builder(meshes, warn);
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
