#include "convert/sdf_convert.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include <tether/base/text.h>

namespace tether::sim {

using uav::Vec3;

namespace {

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
  constexpr std::array<std::string_view, 5> kTypes = {".obj", ".stl", ".dae", ".glb", ".gltf"};
  if (std::ranges::find(kTypes, extension) == kTypes.end()) {
    refuse(source, uri,
           "names '" + mesh.Uri() + "'; meshes are .obj, .stl, .dae, .glb or .gltf files");
  }
  geometry.companions = source.companions_of(geometry.file);
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
  return read_made_shape(source, geometry.Element(), warn);
}

/// Calls `read`. Without --strict, what cannot be used is left out of a world.
template <class Read>
void read_or_leave_out(const SdfSource& source, const sdf::ElementPtr& element,
                       const WarningSink& warn, const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    if (!source.options().is_tolerant || error.code() != ErrorCode::kBadFile) throw;
    warn_at(source, element, Consequence::kMissing, left_out_because(error), warn);
  }
}

double read_friction(const sdf::Collision& collision) {
  const sdf::ElementPtr mu = find_path(collision.Element(), {"surface", "friction", "ode", "mu"});
  return mu ? mu->Get<double>() : Collision{}.friction;
}

/// The engine has 31.
std::uint32_t read_bits(const sdf::Collision& collision) {
  const sdf::ElementPtr mask =
      find_path(collision.Element(), {"surface", "contact", "collide_bitmask"});
  return mask ? mask->Get<unsigned int>() & 0x7fffffffU : Collision{}.bits;
}

/// <laser_retro> of the collision, else of the link's first visual that has one; else the
/// brightness of the first visual's colour, 0 to 1.
double read_intensity(const sdf::ElementPtr& collision, const sdf::Link& link,
                      const std::vector<Visual>& visuals) {
  const auto retro = [](const sdf::ElementPtr& element) {
    return element->HasElement("laser_retro")
               ? std::optional(std::max(0.0, element->Get<double>("laser_retro")))
               : std::nullopt;
  };
  if (const auto own = retro(collision)) return *own;
  for (std::uint64_t i = 0; i < link.VisualCount(); ++i)
    if (const auto shown = retro(link.VisualByIndex(i)->Element())) return *shown;
  if (visuals.empty()) return 0.0;
  const auto& [red, green, blue] = visuals.front().material.diffuse_rgb;
  return (red + green + blue) / 3.0;
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

sdf::ElementPtr find_path(sdf::ElementPtr element, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (!element) return nullptr;
    element = element->FindElement(name);
  }
  return element;
}

std::string extension_of(const std::filesystem::path& file) {
  return lower_case(file.extension().string());
}

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
    read_or_leave_out(source, visual.Element(), warn, [&] {
      const auto geometry = read_geometry(source, *visual.Geom(), warn);
      if (!geometry) return;
      Visual out;
      out.name = visual.Name();
      out.X_LV =
          resolved_pose(source, visual) * offset_of_heightmap(source, visual.Geom()->Element());
      out.geometry = *geometry;
      out.cast_shadows = visual.CastShadows();
      read_look(source, visual.Material(), warn, out);
      out.material.alpha *= 1.0 - double{visual.Transparency()};
      const sdf::ElementPtr heightmap = visual.Geom()->Element()->FindElement("heightmap");
      if (heightmap && out.has_look_of_mesh) {
        out.has_look_of_mesh = false;
        read_look_of_heightmap(source, heightmap, warn, std::get<MeshGeometry>(out.geometry),
                               out.material);
      }
      result.visuals.push_back(std::move(out));
    });
  }
  for (std::uint64_t i = 0; i < link.CollisionCount(); ++i) {
    const sdf::Collision& collision = *link.CollisionByIndex(i);
    read_or_leave_out(source, collision.Element(), warn, [&] {
      const auto geometry = read_geometry(source, *collision.Geom(), warn);
      if (geometry)
        result.collisions.push_back({collision.Name(),
                                     resolved_pose(source, collision) *
                                         offset_of_heightmap(source, collision.Geom()->Element()),
                                     *geometry, read_friction(collision),
                                     read_intensity(collision.Element(), link, result.visuals),
                                     read_bits(collision)});
    });
  }
  return result;
}

}  // namespace tether::sim
