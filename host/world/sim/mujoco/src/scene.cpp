// Converts a World into the renderer's scene: a mesh, a material and an instance for each visual,
// lights, and textures. Files that several visuals name are read once.

#include "scene.h"

#include "meshes/named_file.h"
#include "scene_textures.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

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

// Of a part of a mesh, in SceneParts.
struct PartNumbers {
  std::size_t mesh;
  std::size_t material;
};

constexpr Vec3 kWhite{1.0, 1.0, 1.0};

raster::Material tinted(raster::Material material, const Material& tint) {
  const auto scale = [](raster::Rgb& colour, const Vec3& by) {
    const raster::Rgb factor = rgb(by);
    for (std::size_t i = 0; i < 3; ++i) colour[i] = std::min(1.0F, colour[i] * factor[i]);
  };
  scale(material.diffuse, tint.diffuse_rgb);
  scale(material.ambient, tint.ambient_rgb);
  material.alpha *= static_cast<float>(tint.alpha);
  return material;
}

class SceneBuilder {
 public:
  SceneBuilder(const MeshFiles& mesh_files, const WarningSink& warn)
      : mesh_files_(mesh_files), warn_(warn) {}

  /// `turned` is the body before the first of its parts behind joints.
  void add_link(const Link& link, const Pose& X, std::optional<std::size_t> body,
                std::uint32_t entity, std::size_t turned = 0) {
    for (const Visual& visual : link.visuals) {
      raster::Instance instance;
      instance.body = visual.joints == 0 ? body : turned + visual.joints;
      instance.hidden_with = body;
      instance.X_BV = X * visual.X_LV;
      instance.cast_shadows = visual.cast_shadows;
      instance.entity = entity;
      const auto* mesh = std::get_if<MeshGeometry>(&visual.geometry);
      if (mesh != nullptr && visual.has_look_of_mesh) {
        add_parts(*mesh, visual.material, instance);
        continue;
      }
      instance.mesh = mesh_of(visual);
      instance.material = parts_.materials.size();
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
  /// What the materials number.
  const std::vector<TextureSource>& textures() const { return sources_; }

 private:
  static float factor(double attenuation) { return static_cast<float>(std::min(attenuation, 1e6)); }

  // A mesh with the looks of its file: an instance for each of its materials.
  void add_parts(const MeshGeometry& geometry, const Material& tint, raster::Instance instance) {
    read_named(geometry.named_at, [&] {
      const auto [known, is_new] = looks_.try_emplace(key_of(geometry));
      if (is_new)
        for (MeshPart& part : mesh_files_.parts(geometry, warn_)) add_part(part, known->second);
      for (const auto& [mesh, material] : known->second) {
        count_triangles(geometry, parts_.meshes[mesh]);
        instance.mesh = mesh;
        instance.material = material;
        if (tint.alpha != 1.0 || tint.diffuse_rgb != kWhite || tint.ambient_rgb != kWhite) {
          instance.material = parts_.materials.size();
          parts_.materials.push_back(tinted(parts_.materials[material], tint));
        }
        parts_.instances.push_back(instance);
      }
    });
  }

  void add_part(MeshPart& part, std::vector<PartNumbers>& numbers) {
    raster::Material material = material_of(part.look.material);
    if (part.look.picture) material.texture = texture_of({{}, {}, part.look.picture});
    numbers.push_back({add_mesh(std::move(part.mesh)), parts_.materials.size()});
    parts_.materials.push_back(material);
  }

  std::size_t add_mesh(raster::Mesh mesh) {
    parts_.meshes.push_back(std::move(mesh));
    return parts_.meshes.size() - 1;
  }

  std::size_t mesh_of(const Visual& visual) {
    const Material& material = visual.material;
    const TextureScale scale{material.texture_repeat_x, material.texture_repeat_y,
                             material.texture_repeat};
    const auto add = [&](raster::Mesh mesh) {
      if (material.is_double_sided) add_inside(mesh);
      return add_mesh(std::move(mesh));
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
              const std::tuple key{key_of(g), scale.repeat_x, scale.repeat_y, scale.over,
                                   material.is_double_sided};
              return read_named(g.named_at, [&] {
                const auto [known, is_new] = meshes_.try_emplace(key);
                if (is_new) known->second = add(mesh_files_.load(g, scale));
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
    if (!in.albedo_map.empty()) material.texture = texture_of({in.albedo_map, in.albedo_map_at});
    return material;
  }

  std::size_t texture_of(const TextureSource& source) {
    const auto [known, is_new] = textures_.try_emplace({source.file, source.picture});
    if (is_new) {
      known->second = sources_.size();
      sources_.push_back(source);
    }
    return known->second;
  }

  const MeshFiles& mesh_files_;
  const WarningSink& warn_;
  raster::SceneParts parts_;
  std::vector<TextureSource> sources_;  // of the textures, by their numbers
  std::size_t triangles_ = 0;
  std::map<std::tuple<MeshKey, double, double, TextureRepeat, bool>, std::size_t> meshes_;
  std::map<MeshKey, std::vector<PartNumbers>> looks_;
  // Never walked through.
  std::map<std::pair<std::filesystem::path, std::shared_ptr<const raster::Texture>>, std::size_t>
      textures_;
};

}  // namespace

raster::SceneParts make_scene(const World& world, const WarningSink& warn, const MeshFiles& meshes,
                              const std::optional<FileCache>& cache) {
  SceneBuilder builder(meshes, warn);
  const auto number_of = [&](const Model* model) {
    return static_cast<std::uint32_t>(model - world.models.data()) + 1;
  };
  for (const FixedBody& body : fixed_bodies(world)) {
    builder.add_link(*body.link, body.X_WB, std::nullopt, number_of(body.model));
  }
  const std::vector<MovingBody> moving = moving_bodies(world);
  std::size_t turned = moving.size() - 1;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const auto uav = static_cast<std::uint32_t>(world.models.size() + i) + 1;
    builder.add_link(*moving[i].link, {}, i, moving[i].uav ? uav : number_of(moving[i].model),
                     turned);
    turned += moving[i].uav ? moving[i].uav->joints.size() : 0;
  }
  for (const Light& light : world.lights) builder.add_light(light);
  raster::SceneParts parts = builder.take();
  parts.ambient = rgb(world.ambient_rgb);
  parts.background = rgb(world.background_rgb);
  add_textures(builder.textures(), world.is_strict, warn, cache, parts);
  return parts;
}

}  // namespace tether::sim
