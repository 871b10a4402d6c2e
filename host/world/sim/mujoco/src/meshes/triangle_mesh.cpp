// Triangle meshes of the primitive shapes. Boxes and planes consist of rectangles, all others of
// surfaces of revolution given by their profile.

#include "meshes/triangle_mesh.h"

#include "conversions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tether::sim {
namespace {

using uav::Vec3;
using Vertex = raster::Mesh::Vertex;

constexpr int kSlices = 32;
constexpr int kStacksPerQuarter = 8;

Vertex make_vertex(const Vec3& position, const Vec3& normal, double u, double v) {
  Vertex vertex;
  copy_to(position, vertex.position.data());
  copy_to(normal, vertex.normal.data());
  vertex.uv = {static_cast<float>(u), static_cast<float>(v)};
  return vertex;
}

std::uint32_t index(std::size_t i) {
  return static_cast<std::uint32_t>(i);
}

// Two triangles for each cell of a (rows+1) × (columns+1) lattice of vertices whose rows run down
// and whose columns run right, seen from outside.
void add_lattice_triangles(raster::Mesh& mesh, std::size_t first, int rows, int columns) {
  const auto stride = static_cast<std::size_t>(columns) + 1;
  for (std::size_t r = 0; r < static_cast<std::size_t>(rows); ++r) {
    for (std::size_t c = 0; c + 1 < stride; ++c) {
      const std::size_t a = first + r * stride + c;
      mesh.triangles.push_back({index(a), index(a + stride), index(a + stride + 1)});
      mesh.triangles.push_back({index(a), index(a + stride + 1), index(a + 1)});
    }
  }
}

// A flat rectangle around `centre`; `right` and `down` are unit, seen from outside.
void add_rectangle(raster::Mesh& mesh, const Vec3& centre, const Vec3& right, double width_m,
                   const Vec3& down, double height_m, const TextureScale& scale) {
  const Vec3 normal = cross(down, right);
  const Vec3 corner = centre - 0.5 * width_m * right - 0.5 * height_m * down;
  const std::size_t first = mesh.vertices.size();
  for (const double y : {0.0, height_m}) {
    for (const double x : {0.0, width_m}) {
      mesh.vertices.push_back(make_vertex(corner + x * right + y * down, normal,
                                          scale.left() + (x > 0.0 ? scale.across(x) : 0.0),
                                          scale.top() + (y > 0.0 ? scale.down(y) : 0.0)));
    }
  }
  add_lattice_triangles(mesh, first, 1, 1);
}

// One ring of a surface of revolution about z.
struct Ring {
  double radius_m;
  double z_m;
  double normal_r;    // the normal's radial part
  double normal_z;    // and its part along z
  double distance_m;  // along the profile from the top: the texture's v
};

// The profile runs from top to bottom.
void add_revolution(raster::Mesh& mesh, const std::vector<Ring>& profile, double texture_radius_m,
                    const TextureScale& scale) {
  const std::size_t first = mesh.vertices.size();
  const bool is_per_face = scale.over == TextureRepeat::kPerFace;
  const double whole = is_per_face ? profile.back().distance_m : 1.0;
  for (const Ring& ring : profile) {
    for (int i = 0; i <= kSlices; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kSlices;
      const double c = std::cos(angle);
      const double s = std::sin(angle);
      mesh.vertices.push_back(
          make_vertex({ring.radius_m * c, ring.radius_m * s, ring.z_m},
                      {ring.normal_r * c, ring.normal_r * s, ring.normal_z},
                      scale.left() + (is_per_face ? scale.repeat_x * i / kSlices
                                                  : angle * texture_radius_m * scale.repeat_x),
                      scale.top() + ring.distance_m / whole * scale.repeat_y));
    }
  }
  add_lattice_triangles(mesh, first, static_cast<int>(profile.size()) - 1, kSlices);
}

// A flat disc at height z, facing `up` (+1 or −1).
void add_disc(raster::Mesh& mesh, double radius_m, double z_m, double up,
              const TextureScale& scale) {
  const Ring centre{0.0, z_m, 0.0, up, 0.0};
  const Ring rim{radius_m, z_m, 0.0, up, 0.0};
  const std::vector<Ring> profile = up > 0.0 ? std::vector{centre, rim} : std::vector{rim, centre};
  const std::size_t first = mesh.vertices.size();
  add_revolution(mesh, profile, 1.0, {});
  const bool is_per_face = scale.over == TextureRepeat::kPerFace;
  const double per_m = is_per_face ? 0.5 / radius_m : 1.0;
  const auto corner = is_per_face ? 0.5F : 0.0F;
  for (std::size_t i = first; i < mesh.vertices.size(); ++i) {
    Vertex& vertex = mesh.vertices[i];
    vertex.uv[0] = corner + vertex.position[0] * static_cast<float>(per_m * scale.repeat_x);
    vertex.uv[1] = corner + vertex.position[1] * static_cast<float>(-up * per_m * scale.repeat_y);
  }
}

// The rings of a quarter circle, from polar angle `from` to `from` + 90°, around height z.
void append_quarter(std::vector<Ring>& profile, double radius_m, double z_m, double from,
                    double distance_m) {
  for (int i = 0; i <= kStacksPerQuarter; ++i) {
    const double turned = 0.5 * std::numbers::pi * i / kStacksPerQuarter;
    const double polar = from + turned;
    profile.push_back({radius_m * std::sin(polar), z_m + radius_m * std::cos(polar),
                       std::sin(polar), std::cos(polar), distance_m + radius_m * turned});
  }
}

void append_side(std::vector<Ring>& profile, double radius_m, double length_m, double distance_m) {
  profile.push_back({radius_m, 0.5 * length_m, 1.0, 0.0, distance_m});
  profile.push_back({radius_m, -0.5 * length_m, 1.0, 0.0, distance_m + length_m});
}

}  // namespace

raster::Mesh box_mesh(const Vec3& size_m, const TextureScale& scale) {
  const auto [x, y, z] = size_m;
  const Vec3 down{0.0, 0.0, -1.0};
  raster::Mesh mesh;
  add_rectangle(mesh, {0.5 * x, 0.0, 0.0}, {0.0, 1.0, 0.0}, y, down, z, scale);
  add_rectangle(mesh, {-0.5 * x, 0.0, 0.0}, {0.0, -1.0, 0.0}, y, down, z, scale);
  add_rectangle(mesh, {0.0, 0.5 * y, 0.0}, {-1.0, 0.0, 0.0}, x, down, z, scale);
  add_rectangle(mesh, {0.0, -0.5 * y, 0.0}, {1.0, 0.0, 0.0}, x, down, z, scale);
  if (scale.over == TextureRepeat::kPerFace) {
    add_rectangle(mesh, {0.0, 0.0, 0.5 * z}, {0.0, -1.0, 0.0}, y, {-1.0, 0.0, 0.0}, x, scale);
    add_rectangle(mesh, {0.0, 0.0, -0.5 * z}, {0.0, -1.0, 0.0}, y, {1.0, 0.0, 0.0}, x, scale);
  } else {
    add_rectangle(mesh, {0.0, 0.0, 0.5 * z}, {1.0, 0.0, 0.0}, x, {0.0, -1.0, 0.0}, y, scale);
    add_rectangle(mesh, {0.0, 0.0, -0.5 * z}, {-1.0, 0.0, 0.0}, x, {0.0, -1.0, 0.0}, y, scale);
  }
  return mesh;
}

raster::Mesh cylinder_mesh(double radius_m, double length_m, const TextureScale& scale) {
  raster::Mesh mesh;
  std::vector<Ring> side;
  append_side(side, radius_m, length_m, 0.0);
  add_revolution(mesh, side, radius_m, scale);
  add_disc(mesh, radius_m, 0.5 * length_m, 1.0, scale);
  add_disc(mesh, radius_m, -0.5 * length_m, -1.0, scale);
  return mesh;
}

raster::Mesh capsule_mesh(double radius_m, double length_m, const TextureScale& scale) {
  const double quarter_m = 0.5 * std::numbers::pi * radius_m;
  std::vector<Ring> profile;
  append_quarter(profile, radius_m, 0.5 * length_m, 0.0, 0.0);
  append_side(profile, radius_m, length_m, quarter_m);
  append_quarter(profile, radius_m, -0.5 * length_m, 0.5 * std::numbers::pi, quarter_m + length_m);
  raster::Mesh mesh;
  add_revolution(mesh, profile, radius_m, scale);
  return mesh;
}

raster::Mesh ellipsoid_mesh(const Vec3& radii_m, const TextureScale& scale) {
  const double mean_m = (radii_m.x + radii_m.y + radii_m.z) / 3.0;
  TextureScale unit = scale;
  if (scale.over == TextureRepeat::kPerMetre)
    unit = {scale.repeat_x * mean_m, scale.repeat_y * mean_m};
  std::vector<Ring> profile;
  append_quarter(profile, 1.0, 0.0, 0.0, 0.0);
  append_quarter(profile, 1.0, 0.0, 0.5 * std::numbers::pi, 0.5 * std::numbers::pi);
  raster::Mesh mesh;
  add_revolution(mesh, profile, 1.0, unit);
  for (Vertex& vertex : mesh.vertices) {
    const auto [x, y, z] = vertex.position;
    const Vec3 normal{x / radii_m.x, y / radii_m.y, z / radii_m.z};
    copy_to((1.0 / norm(normal)) * normal, vertex.normal.data());
    copy_to(Vec3{x * radii_m.x, y * radii_m.y, z * radii_m.z}, vertex.position.data());
  }
  return mesh;
}

raster::Mesh plane_mesh(const PlaneGeometry& plane, const TextureScale& scale) {
  const uav::Quat q = rotation_from_z(plane.normal);
  raster::Mesh mesh;
  add_rectangle(mesh, {}, rotate(q, {1.0, 0.0, 0.0}), plane.size_x_m, rotate(q, {0.0, -1.0, 0.0}),
                plane.size_y_m, scale);
  return mesh;
}

void add_inside(raster::Mesh& mesh) {
  const auto corners = static_cast<std::uint32_t>(mesh.vertices.size());
  const std::size_t triangles = mesh.triangles.size();
  for (std::uint32_t i = 0; i < corners; ++i) {
    raster::Mesh::Vertex v = mesh.vertices[i];
    for (float& part : v.normal) part = -part;
    mesh.vertices.push_back(v);
  }
  for (std::size_t i = 0; i < triangles; ++i) {
    const auto [a, b, c] = mesh.triangles[i];
    mesh.triangles.push_back({corners + a, corners + c, corners + b});
  }
}

uav::Quat rotation_from_z(const Vec3& normal) {
  const double length = norm(normal);
  if (length == 0.0) return {};
  const Vec3 n = (1.0 / length) * normal;
  const Vec3 axis = cross({0.0, 0.0, 1.0}, n);
  const double sine = norm(axis);
  if (sine < 1e-12) return n.z > 0.0 ? uav::Quat{} : uav::Quat{0.0, 1.0, 0.0, 0.0};
  return uav::from_axis_angle((1.0 / sine) * axis, std::atan2(sine, n.z));
}

}  // namespace tether::sim
