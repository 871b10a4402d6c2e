#include "scene/prepared_scene.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <tether/base/error.h>
#include <tether/sim_raster/scene.h>

namespace tether::raster {
namespace {

constexpr float kOpaque = 0.995F;

[[noreturn]] void refuse(const std::string& subject, const std::string& what) {
  throw Error(ErrorCode::kBadFile, subject + ": " + what).about(subject);
}

void require(bool condition, const std::string& subject, const char* what) {
  if (!condition) refuse(subject, what);
}

bool is_near(double v) {
  return std::abs(v) <= kMaxCoordinate_m;  // false for what is not a number
}
bool is_near(const uav::Vec3& v) {
  return is_near(v.x) && is_near(v.y) && is_near(v.z);
}
template <std::size_t N>
bool is_near(const std::array<float, N>& v) {
  return std::all_of(v.begin(), v.end(), [](float f) { return is_near(f); });
}
bool is_share(float f) {
  return f >= 0.0F && f <= 1.0F;
}
bool is_colour(const Rgb& c) {
  return std::all_of(c.begin(), c.end(), is_share);
}
// Light may be brighter than white.
bool is_light(const Rgb& c) {
  return std::all_of(c.begin(), c.end(), [](float f) { return f >= 0.0F && f <= 1e6F; });
}
bool is_usable_pose(const uav::Pose& X) {
  const double length = X.q.w * X.q.w + X.q.x * X.q.x + X.q.y * X.q.y + X.q.z * X.q.z;
  return is_near(X.p) && std::abs(length - 1.0) < 1e-6;
}

void check(const Mesh& mesh, const std::string& name) {
  require(mesh.triangles.size() <= kMaxTriangles, name, "more than 10,000,000 triangles");
  require(std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                      [](const Mesh::Vertex& v) {
                        return is_near(v.position) && is_near(v.normal) && is_near(v.uv);
                      }),
          name,
          "a number of a vertex (place, normal or texture coordinate) is not finite, or beyond "
          "1,000,000");
  for (const auto& triangle : mesh.triangles) {
    require(std::all_of(triangle.begin(), triangle.end(),
                        [&](std::uint32_t i) { return i < mesh.vertices.size(); }),
            name, "an index is not that of a vertex");
  }
}

void check(const Material& material, const std::string& name, std::size_t textures) {
  require(is_colour(material.ambient) && is_colour(material.diffuse) &&
              is_colour(material.specular) && is_colour(material.emissive) &&
              is_share(material.alpha),
          name, "a colour is not within 0 to 1");
  require(material.shininess >= 0.0F && material.shininess <= 1000.0F, name,
          "its shininess is not within 0 to 1000");
  require(!material.texture || *material.texture < textures, name, "its texture does not exist");
}

void check(const Instance& instance, const std::string& name, const SceneParts& parts) {
  require(instance.mesh < parts.meshes.size(), name, "its mesh does not exist");
  require(instance.material < parts.materials.size(), name, "its material does not exist");
  require(!instance.body || *instance.body < kMaxBodies, name, "its body is beyond 100,000");
  require(is_usable_pose(instance.X_BV), name,
          "its pose is not finite, beyond 1,000 km, or its quaternion is not unit");
}

void check(const Light& light, const std::string& name) {
  require(
      is_near(light.p_WL) && is_near(light.direction_W), name,
      "its place is beyond 1,000 km, or a part of its direction is not finite or beyond 1,000,000");
  require(norm(light.direction_W) > 0.0, name, "it has no direction");
  require(is_light(light.diffuse) && is_light(light.specular), name,
          "a colour times its intensity is negative, not finite, or beyond 1,000,000");
  const auto is_factor = [](float f) { return f >= 0.0F && f <= 1e6F; };
  require(is_factor(light.attenuation_constant) && is_factor(light.attenuation_linear) &&
              is_factor(light.attenuation_quadratic) &&
              light.attenuation_constant + light.attenuation_linear + light.attenuation_quadratic >
                  0.0F,
          name, "its attenuation is negative, not finite, or 0");
  require(!light.cast_shadows || light.kind != LightKind::kPoint, name,
          "a point light casts no shadows");
  require(light.spot_half_angle_rad >= 0.0 && light.spot_half_angle_rad <= 1.5708, name,
          "its angle is not within 0 to 90 degrees");
  require(light.spot_exponent >= 0.0F && light.spot_exponent <= 1000.0F, name,
          "its exponent is not within 0 to 1000");
}

template <class Part, class... More>
void check_all(const std::vector<Part>& parts, const std::string& name, const More&... more) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    check(parts[i], name + ' ' + std::to_string(i), more...);
  }
}

void check_totals(const SceneParts& parts) {
  require(parts.instances.size() <= kMaxInstances, "scene", "more than 1,000,000 visuals");
  require(parts.lights.size() <= kMaxLights, "scene", "more than 32 lights");
  require(is_light(parts.ambient) && is_colour(parts.background), "scene",
          "its ambient light or its background is not a colour");
  std::size_t triangles = 0;
  for (const Instance& i : parts.instances) {
    triangles += parts.meshes[i.mesh].triangles.size();
    require(triangles <= kMaxTriangles, "scene", "more than 10,000,000 triangles");
  }
}

MaterialRow make_row(const Material& m, const Rgb& ambient) {
  MaterialRow row{};
  for (std::size_t i = 0; i < 3; ++i) row.base[i] = m.emissive[i] + m.ambient[i] * ambient[i];
  row.diffuse = m.diffuse;
  row.specular = m.specular;
  row.shininess = m.shininess;
  row.alpha = m.alpha;
  row.levels = 1;
  row.is_shiny = m.specular[0] > 0.0F || m.specular[1] > 0.0F || m.specular[2] > 0.0F ? 1 : 0;
  return row;
}

class Preparation {
 public:
  Preparation(const SceneParts& parts, TextureSet textures) : parts_(parts) {
    scene_.texels = textures.prepared().all_texels;
    scene_.levels = textures.prepared().levels;
    scene_.textures = std::move(textures);
  }

  PreparedScene make() {
    scene_.background = parts_.background;
    scene_.lights = parts_.lights;
    for (Light& l : scene_.lights) l.direction_W = (1.0 / norm(l.direction_W)) * l.direction_W;
    for (const Mesh& mesh : parts_.meshes) scene_.meshes.push_back(add_mesh(mesh, scene_));
    add_materials();
    for (const Instance& instance : parts_.instances) add(instance);
    find_shadows();
    return std::move(scene_);
  }

 private:
  void add_materials() {
    for (const Material& material : parts_.materials) {
      MaterialRow row = make_row(material, parts_.ambient);
      bool seen_through = material.alpha < kOpaque;
      if (material.texture) {
        const TextureRow& texture = scene_.textures->prepared().rows[*material.texture];
        row.first_level = texture.first_level;
        row.levels = texture.levels;
        row.texture_width = static_cast<float>(texture.width_px);
        row.texture_height = static_cast<float>(texture.height_px);
        seen_through = seen_through || texture.is_transparent != 0;
      }
      scene_.materials.push_back(row);
      transparent_materials_.push_back(seen_through);
    }
  }

  void add(const Instance& in) {
    const PreparedMesh& mesh = scene_.meshes[in.mesh];
    PreparedInstance out{};
    out.mesh = static_cast<std::uint32_t>(in.mesh);
    out.material = static_cast<std::uint32_t>(in.material);
    out.body = in.body ? static_cast<std::int32_t>(*in.body) : -1;
    out.hidden_with = in.hidden_with ? static_cast<std::int32_t>(*in.hidden_with) : out.body;
    out.entity = in.entity;
    out.first_primitive = next_primitive_;
    out.transparent = transparent_materials_[in.material];
    out.cast_shadows = in.cast_shadows && !out.transparent;
    out.X_BV = in.X_BV;
    out.bounds_B = {transform(in.X_BV, mesh.bounds.centre), mesh.bounds.radius_m};
    next_primitive_ += mesh.triangles;
    scene_.any_transparent = scene_.any_transparent || out.transparent;
    scene_.instances.push_back(out);
    if (in.body) include(*in.body, norm(out.bounds_B.centre), mesh);
  }

  void include(std::size_t body, double centre_m, const PreparedMesh& mesh) {
    auto& radii = scene_.body_radii_m;
    if (radii.size() <= body) radii.resize(body + 1, 0.0);
    radii[body] = std::max(radii[body], centre_m + mesh.bounds.radius_m);
  }

  void find_shadows() {
    const auto casts = [](const auto& what) { return what.cast_shadows; };
    scene_.any_shadow = std::any_of(scene_.lights.begin(), scene_.lights.end(), casts) &&
                        std::any_of(scene_.instances.begin(), scene_.instances.end(), casts);
  }

  const SceneParts& parts_;
  PreparedScene scene_;
  std::vector<bool> transparent_materials_;
  std::uint32_t next_primitive_ = 1;
};

}  // namespace

Scene::Scene(const SceneParts& parts) {
  check_all(parts.meshes, "mesh");
  TextureSet textures = parts.texture_set ? *parts.texture_set : TextureSet(parts.textures);
  check_all(parts.materials, "material", textures.size());
  check_all(parts.instances, "visual", parts);
  check_all(parts.lights, "light");
  check_totals(parts);
  prepared_ = std::make_unique<const PreparedScene>(Preparation(parts, std::move(textures)).make());
}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

std::size_t Scene::bodies() const {
  return prepared_->body_radii_m.size();
}

const std::vector<double>& Scene::body_radii_m() const {
  return prepared_->body_radii_m;
}

}  // namespace tether::raster
