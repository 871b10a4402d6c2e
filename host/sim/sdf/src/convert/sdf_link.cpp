#include "convert/sdf_convert.h"

#include <cctype>
#include <initializer_list>
#include <optional>

namespace tether::sim {

using uav::Vec3;

namespace {

sdf::ElementPtr find_path(sdf::ElementPtr element, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (!element) return nullptr;
    element = element->FindElement(name);
  }
  return element;
}

std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

std::optional<MeshGeometry> read_mesh(const SdfSource& source, const sdf::Mesh& mesh,
                                      const WarningSink& warn) {
  const sdf::ElementPtr uri = find_path(mesh.Element(), {"uri"});
  if (!uri || mesh.Uri().empty()) refuse(source, mesh.Element(), "has no file name in <uri>");
  MeshGeometry geometry{source.find_resource(uri, mesh.Uri()), mesh.Submesh(),
                        to_vec3(mesh.Scale()), mesh.CenterSubmesh() && !mesh.Submesh().empty(),
                        source.where(uri)};
  if (geometry.file.empty()) {
    warn_at(source, uri, Consequence::kMissing,
            "names '" + mesh.Uri() + "', which is not found; left out", warn);
    return std::nullopt;
  }
  const std::string extension = extension_of(geometry.file);
  if (extension != ".obj" && extension != ".stl" && extension != ".dae") {
    refuse(source, uri, "names '" + mesh.Uri() + "'; meshes are .obj, .stl or .dae files");
  }
  return geometry;
}

PlaneGeometry read_plane(const SdfSource& source, const sdf::Plane& plane) {
  const Vec3 normal = to_vec3(plane.Normal());
  if (norm(normal) == 0.0) refuse(source, plane.Element(), "has a <normal> of length 0");
  return {normal, plane.Size().X(), plane.Size().Y()};
}

/// None for shapes that are not represented: the check of the elements has warned of them.
std::optional<Geometry> read_geometry(const SdfSource& source, const sdf::Geometry& geometry,
                                      const WarningSink& warn) {
  if (const auto* box = geometry.BoxShape()) return BoxGeometry{to_vec3(box->Size())};
  if (const auto* c = geometry.CylinderShape()) return CylinderGeometry{c->Radius(), c->Length()};
  if (const auto* sphere = geometry.SphereShape()) return SphereGeometry{sphere->Radius()};
  if (const auto* c = geometry.CapsuleShape()) return CapsuleGeometry{c->Radius(), c->Length()};
  if (const auto* e = geometry.EllipsoidShape()) return EllipsoidGeometry{to_vec3(e->Radii())};
  if (const auto* plane = geometry.PlaneShape()) return read_plane(source, *plane);
  if (const auto* mesh = geometry.MeshShape()) return read_mesh(source, *mesh, warn);
  return std::nullopt;
}

void read_albedo_map(const SdfSource& source, const sdf::ElementPtr& element,
                     const WarningSink& warn, Material& material) {
  sdf::ElementPtr map = find_path(element, {"pbr", "metal", "albedo_map"});
  if (!map) map = find_path(element, {"pbr", "specular", "albedo_map"});
  if (!map || map->Get<std::string>().empty()) return;
  const std::filesystem::path file = source.find_resource(map, map->Get<std::string>());
  const std::string extension = extension_of(file);
  if (extension == ".png" || extension == ".jpg" || extension == ".jpeg") {
    material.albedo_map = file;
    material.albedo_map_at = source.where(map);
    return;
  }
  warn_at(source, map, Effect(Consequence::kLooksDifferent, true),
          "names '" + map->Get<std::string>() +
              (file.empty() ? "', which is not found; the colours are used"
                            : "', which is neither a PNG nor a JPEG file; the colours are used"),
          warn);
}

/// A colour that the file gives, or `otherwise`.
Vec3 color_or(const sdf::Material& material, const char* name, const ignition::math::Color& color,
              const Vec3& otherwise) {
  return material.Element()->HasElement(name) ? to_vec3(color) : otherwise;
}

void read_texture(const SdfSource& source, const sdf::ElementPtr& element, const WarningSink& warn,
                  Material& material) {
  read_albedo_map(source, element, warn, material);
  const sdf::ElementPtr repeat = find_path(element, {"tether:texture_repeat"});
  if (!repeat) return;
  const std::vector<double> numbers = read_numbers(source, repeat, 2);
  if (numbers[0] <= 0.0 || numbers[1] <= 0.0) {
    refuse(source, repeat, "must be two numbers greater than 0: repetitions per metre");
  }
  material.texture_repeat_x = numbers[0];
  material.texture_repeat_y = numbers[1];
}

/// Colours not given: a texture shows as it is, an untextured surface is grey; ambient is diffuse.
Material read_material(const SdfSource& source, const sdf::Visual& visual,
                       const WarningSink& warn) {
  Material material;
  const sdf::Material* given = visual.Material();
  double opacity = 1.0;
  if (given != nullptr) {
    read_texture(source, given->Element(), warn, material);
    const Vec3 plain = material.albedo_map.empty() ? material.diffuse_rgb : Vec3{1.0, 1.0, 1.0};
    material.diffuse_rgb = color_or(*given, "diffuse", given->Diffuse(), plain);
    material.ambient_rgb = color_or(*given, "ambient", given->Ambient(), material.diffuse_rgb);
    material.specular_rgb = color_or(*given, "specular", given->Specular(), {});
    material.emissive_rgb = color_or(*given, "emissive", given->Emissive(), {});
    if (given->Element()->HasElement("diffuse")) opacity = double{given->Diffuse().A()};
  }
  material.alpha = opacity * (1.0 - double{visual.Transparency()});
  return material;
}

double read_friction(const sdf::Collision& collision) {
  const sdf::ElementPtr mu = find_path(collision.Element(), {"surface", "friction", "ode", "mu"});
  return mu ? mu->Get<double>() : Collision{}.friction;
}

void read_inertial(const ignition::math::Inertiald& inertial, Link& link) {
  const auto& mass_matrix = inertial.MassMatrix();
  link.mass_kg = mass_matrix.Mass();
  link.X_LI = to_pose(inertial.Pose());
  link.inertia_kg_m2 = to_vec3(mass_matrix.DiagonalMoments());
  if (mass_matrix.OffDiagonalMoments() == ignition::math::Vector3d::Zero) return;
  link.inertia_kg_m2 = to_vec3(mass_matrix.PrincipalMoments());
  const ignition::math::Quaterniond q = mass_matrix.PrincipalAxesOffset();
  link.X_LI.q = link.X_LI.q * uav::Quat{q.W(), q.X(), q.Y(), q.Z()};
}

}  // namespace

Vec3 to_vec3(const ignition::math::Vector3d& v) {
  return {v.X(), v.Y(), v.Z()};
}

Vec3 to_vec3(const ignition::math::Color& color) {
  return {double{color.R()}, double{color.G()}, double{color.B()}};
}

uav::Pose to_pose(const ignition::math::Pose3d& pose) {
  const auto& q = pose.Rot();
  return {to_vec3(pose.Pos()), {q.W(), q.X(), q.Y(), q.Z()}};
}

Link read_link(const SdfSource& source, const sdf::Link& link, const WarningSink& warn) {
  Link result;
  result.name = link.Name();
  result.X_ML = resolved_pose(source, link);
  read_inertial(link.Inertial(), result);
  for (std::uint64_t i = 0; i < link.VisualCount(); ++i) {
    const sdf::Visual& visual = *link.VisualByIndex(i);
    const auto geometry = read_geometry(source, *visual.Geom(), warn);
    if (!geometry) continue;
    result.visuals.push_back({visual.Name(), resolved_pose(source, visual), *geometry,
                              read_material(source, visual, warn), visual.CastShadows()});
  }
  for (std::uint64_t i = 0; i < link.CollisionCount(); ++i) {
    const sdf::Collision& collision = *link.CollisionByIndex(i);
    const auto geometry = read_geometry(source, *collision.Geom(), warn);
    if (!geometry) continue;
    result.collisions.push_back(
        {collision.Name(), resolved_pose(source, collision), *geometry, read_friction(collision)});
  }
  return result;
}

}  // namespace tether::sim
