#include "convert/sdf_convert.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include <tether/os/text_file.h>

// Shapes that are meshes of Tether's own: cones, polylines, roads and heightmaps. The mesh of a
// heightmap is its picture; the others are written as text of an OBJ file.
namespace tether::sim {
namespace {

using uav::Vec3;

/// An OBJ file of flat faces, or of faces with a normal for each corner.
class ObjText {
 public:
  /// For the face that is added next.
  void add_texture_corner(double u, double v) { text_ += fmt::format("vt {:f} {:f}\n", u, v); }
  void add_face(const std::vector<Vec3>& corners, const std::vector<Vec3>& normals,
                bool has_texture = false) {
    std::string face = "f";
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto [x, y, z] = corners[i];
      const auto [nx, ny, nz] = normals[i % normals.size()];
      text_ += fmt::format("v {:f} {:f} {:f}\nvn {:f} {:f} {:f}\n", x, y, z, nx, ny, nz);
      ++corners_;
      face +=
          has_texture ? fmt::format(" {0}/{0}/{0}", corners_) : fmt::format(" {0}//{0}", corners_);
    }
    text_ += face + "\n";
  }

  MeshGeometry take(const char* kind, FileLocation named_at) const {
    MeshGeometry mesh;
    mesh.file = std::string(kind) + " " + os::digest_of(text_);
    mesh.named_at = std::move(named_at);
    mesh.made = std::make_shared<const std::string>(text_);
    return mesh;
  }

 private:
  std::string text_;
  std::size_t corners_ = 0;
};

double length_of(const SdfSource& source, const sdf::ElementPtr& shape, const char* name) {
  const auto value = read_number(source, shape, name);
  if (!value || *value <= 0.0)
    refuse(source, shape, std::string("needs a <") + name + "> greater than 0");
  return *value;
}

/// Its middle is the origin, its tip above.
MeshGeometry read_cone(const SdfSource& source, const sdf::ElementPtr& cone) {
  constexpr int kSlices = 32;
  const double r = length_of(source, cone, "radius");
  const double half = 0.5 * length_of(source, cone, "length");
  const auto around = [&](double slice, double radius, double z) {
    const double angle = 2.0 * std::numbers::pi * slice / kSlices;
    return Vec3{radius * std::cos(angle), radius * std::sin(angle), z};
  };
  ObjText obj;
  for (int i = 0; i < kSlices; ++i) {
    const auto normal = [&](double slice) { return around(slice, 2.0 * half, r); };
    obj.add_face({around(i, r, -half), around(i + 1, r, -half), {0.0, 0.0, half}},
                 {normal(i), normal(i + 1), normal(i + 0.5)});
    obj.add_face({around(i + 1, r, -half), around(i, r, -half), {0.0, 0.0, -half}}, {{0, 0, -1}});
  }
  return obj.take("cone", source.where(cone));
}

double turn(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
}

/// Triangles of a polygon that turns left, by cutting ears off.
std::vector<std::array<Vec3, 3>> triangles_of(std::vector<Vec3> points) {
  std::vector<std::array<Vec3, 3>> triangles;
  const auto is_ear = [&](std::size_t i) {
    const std::size_t n = points.size();
    const Vec3 &a = points[(i + n - 1) % n], &b = points[i], &c = points[(i + 1) % n];
    if (turn(a, b, c) <= 0.0) return false;
    for (const Vec3& p : points)
      if (p != a && p != b && p != c && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 &&
          turn(c, a, p) >= 0.0)
        return false;
    return true;
  };
  for (std::size_t i = 0, misses = 0; points.size() > 2 && misses < points.size();) {
    const std::size_t n = points.size();
    i %= n;
    const bool is_flat = turn(points[(i + n - 1) % n], points[i], points[(i + 1) % n]) == 0.0;
    if (!is_flat && !is_ear(i)) {
      ++i, ++misses;
      continue;
    }
    if (!is_flat) triangles.push_back({points[(i + n - 1) % n], points[i], points[(i + 1) % n]});
    points.erase(points.begin() + static_cast<std::ptrdiff_t>(i));
    misses = 0;
  }
  return triangles;
}

/// From z = 0 up to its height.
void add_polyline(const SdfSource& source, const sdf::ElementPtr& polyline, ObjText& obj) {
  constexpr std::size_t kMostPoints = 1000;
  const Vec3 up{0.0, 0.0, length_of(source, polyline, "height")};
  std::vector<Vec3> points;
  for (sdf::ElementPtr point = polyline->FindElement("point"); point;
       point = point->GetNextElement("point")) {
    const auto numbers = read_numbers(source, point, 2);
    points.push_back({numbers[0], numbers[1], 0.0});
  }
  if (points.size() > 1 && points.front() == points.back()) points.pop_back();
  if (points.size() < 3 || points.size() > kMostPoints)
    refuse(source, polyline, "needs 3 to 1000 points");
  double area = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 &a = points[i], &b = points[(i + 1) % points.size()];
    area += a.x * b.y - b.x * a.y;
  }
  if (area < 0.0) points = {points.rbegin(), points.rend()};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 &a = points[i], &b = points[(i + 1) % points.size()];
    obj.add_face({a, b, b + up, a + up}, {{b.y - a.y, a.x - b.x, 0.0}});
  }
  for (const auto& [a, b, c] : triangles_of(points)) {
    obj.add_face({a + up, b + up, c + up}, {{0, 0, 1}});
    obj.add_face({c, b, a}, {{0, 0, -1}});
  }
}

MeshGeometry read_polylines(const SdfSource& source, const sdf::ElementPtr& first,
                            const WarningSink& warn) {
  ObjText obj;
  for (sdf::ElementPtr one = first; one; one = one->GetNextElement("polyline"))
    add_polyline(source, one, obj);
  if (first->GetNextElement("polyline"))
    warn_at(source, first, Consequence::kBehavesDifferent,
            "is one of several: each is a solid of its own, and none a hole", warn);
  return obj.take("polyline", source.where(first));
}

/// A strip along the points, as wide at each, with its texture once for each width of its length.
MeshGeometry strip_along(const std::vector<Vec3>& points, double width_m, FileLocation where) {
  constexpr double kAboveGround_m = 0.01;
  ObjText obj;
  const auto edge = [&](std::size_t i, double side) {
    const Vec3 along = points[std::min(i + 1, points.size() - 1)] - points[i > 0 ? i - 1 : 0];
    const double length = std::max(std::hypot(along.x, along.y), 1e-9);
    const double beside = side * 0.5 * width_m / length;
    return points[i] + Vec3{-beside * along.y, beside * along.x, kAboveGround_m};
  };
  double from = 0.0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double to = from + norm(points[i + 1] - points[i]) / width_m;
    for (const auto& [u, v] : {std::pair(0, from), {1, from}, {1, to}, {0, to}})
      obj.add_texture_corner(u, v);
    obj.add_face({edge(i, 1.0), edge(i, -1.0), edge(i + 1, -1.0), edge(i + 1, 1.0)}, {{0, 0, 1}},
                 true);
    from = to;
  }
  return obj.take("road", std::move(where));
}

std::optional<MeshGeometry> read_heightmap(const SdfSource& source, const sdf::ElementPtr& heights,
                                           const WarningSink& warn) {
  const sdf::ElementPtr uri = heights->FindElement("uri");
  const std::string name = uri ? uri->Get<std::string>() : "";
  MeshGeometry mesh;
  mesh.file = source.find_resource(uri ? uri : heights, name);
  mesh.named_at = source.where(heights);
  const std::string extension = extension_of(mesh.file);
  if (extension != ".png" && extension != ".jpg" && extension != ".jpeg") {
    warn_at(source, heights, Consequence::kMissing,
            "names '" + name +
                (mesh.file.empty() ? "', which is not found; left out"
                                   : "'; heights are PNG or JPEG files; left out"),
            warn);
    return std::nullopt;
  }
  if (const sdf::ElementPtr size = heights->FindElement("size")) {
    const auto numbers = read_numbers(source, size, 3);
    mesh.scale = {numbers[0], numbers[1], numbers[2]};
  }
  if (mesh.scale.x <= 0.0 || mesh.scale.y <= 0.0 || mesh.scale.z <= 0.0)
    refuse(source, heights, "needs a <size> of three numbers greater than 0");
  return mesh;
}

}  // namespace

std::optional<MeshGeometry> read_made_shape(const SdfSource& source,
                                            const sdf::ElementPtr& geometry,
                                            const WarningSink& warn) {
  if (const auto cone = geometry->FindElement("cone")) return read_cone(source, cone);
  if (const auto line = geometry->FindElement("polyline"))
    return read_polylines(source, line, warn);
  if (const auto heights = geometry->FindElement("heightmap"))
    return read_heightmap(source, heights, warn);
  return std::nullopt;
}

std::optional<Model> read_road(const SdfSource& source, const sdf::ElementPtr& road,
                               const WarningSink& warn) {
  std::vector<Vec3> points;
  for (sdf::ElementPtr point = road->FindElement("point"); point;
       point = point->GetNextElement("point"))
    points.push_back(to_vec3(point->Get<ignition::math::Vector3d>()));
  const double width_m = road->Get<double>("width", 1.0).first;
  if (points.size() < 2 || width_m <= 0.0) {
    warn_at(source, road, Consequence::kMissing,
            "needs two points and a width greater than 0; left out", warn);
    return std::nullopt;
  }
  Visual visual;
  visual.name = "road";
  visual.geometry = strip_along(points, width_m, source.where(road));
  visual.cast_shadows = false;
  visual.material.diffuse_rgb = {0.33, 0.33, 0.33};  // Gazebo/Road
  visual.material.ambient_rgb = {0.04, 0.04, 0.04};
  sdf::Material material;
  if (const auto element = road->FindElement("material")) {
    (void)material.Load(element);
    read_look(source, &material, warn, visual);
  }
  Model model{name_attribute(road), {}, true, {}};
  Link& link = model.links.emplace_back();
  link.name = "road";
  link.visuals.push_back(std::move(visual));
  return model;
}

uav::Pose offset_of_heightmap(const SdfSource& source, const sdf::ElementPtr& geometry) {
  const sdf::ElementPtr pos = find_path(geometry, {"heightmap", "pos"});
  if (!pos) return {};
  const auto numbers = read_numbers(source, pos, 3);
  return {{numbers[0], numbers[1], numbers[2]}, {}};
}

void read_look_of_heightmap(const SdfSource& source, const sdf::ElementPtr& heightmap,
                            const WarningSink& warn, const MeshGeometry& mesh, Material& look) {
  const sdf::ElementPtr texture = heightmap->FindElement("texture");
  const sdf::ElementPtr diffuse = find_path(heightmap, {"texture", "diffuse"});
  look.diffuse_rgb = look.ambient_rgb = {0.5, 0.46, 0.38};  // bare earth
  if (!diffuse) return;
  const auto size = read_number(source, texture, "size");
  const auto file = source.find(diffuse, diffuse->Get<std::string>());
  const std::string extension = file ? extension_of(*file) : "";
  if (extension == ".png" || extension == ".jpg" || extension == ".jpeg") {
    look.albedo_map = source.use(*file);
    look.albedo_map_at = source.where(diffuse);
    look.diffuse_rgb = look.ambient_rgb = {1.0, 1.0, 1.0};
    look.texture_repeat = TextureRepeat::kPerFace;
    if (size && *size > 0.0) {
      look.texture_repeat_x = mesh.scale.x / *size;
      look.texture_repeat_y = mesh.scale.y / *size;
    }
  }
  if (look.albedo_map.empty() || texture->GetNextElement("texture"))
    warn_at(source, texture, Effect(Consequence::kLooksDifferent, true),
            look.albedo_map.empty() ? "has no PNG or JPEG file that is found; brown is used"
                                    : "is used alone, without those of other heights",
            warn);
}

}  // namespace tether::sim
