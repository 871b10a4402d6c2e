#include "meshes/mesh_pieces.h"

#include "meshes/convex_patches.h"
#include "meshes/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

namespace tether::sim {

using uav::Vec3;

std::vector<Vec3> distinct(std::vector<Vec3> points) {
  std::ranges::sort(points, {}, [](const Vec3& p) { return std::tuple{p.x, p.y, p.z}; });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

namespace {

constexpr std::size_t kMostTrianglesInPieces = 300'000;

/// The shifts that give points a thickness: none if their hull has one; along their normal if they
/// lie in a plane; to the corners of a cube if they lie on a line. @pre There are points.
std::vector<Vec3> thickness_of(const std::vector<Vec3>& points) {
  constexpr double kHalf_m = kHalfThickness_m, kThin_m = 1e-3, kLine = 1e-6;
  const auto most = [&](const auto& measure) {
    return *std::ranges::max_element(points, {}, measure);
  };
  const Vec3 a = points.front();
  const Vec3 b = most([&](const Vec3& p) { return norm(p - a); });
  const Vec3 c = most([&](const Vec3& p) { return norm(cross(b - a, p - a)); });
  const Vec3 across = cross(b - a, c - a);
  const double length_m = norm(b - a);
  if (norm(across) > kLine * length_m * length_m) {
    const Vec3 normal = (1.0 / norm(across)) * across;
    const auto height_m = [&](const Vec3& p) { return dot(normal, p - a); };
    const auto [low, high] = std::ranges::minmax(points, {}, height_m);
    if (height_m(high) - height_m(low) > kThin_m) return {};
    return {-kHalf_m * normal, kHalf_m * normal};
  }
  std::vector<Vec3> shifts;
  for (int i = 0; i < 8; ++i)
    shifts.push_back({(i & 1) != 0 ? kHalf_m : -kHalf_m, (i & 2) != 0 ? kHalf_m : -kHalf_m,
                      (i & 4) != 0 ? kHalf_m : -kHalf_m});
  return shifts;
}

/// The triangles of a mesh that have an area, each once: some are there for both of their sides.
Surface triangles_of(const raster::Mesh& mesh) {
  const auto place = [&](std::uint32_t vertex) {
    const auto& [x, y, z] = mesh.vertices[vertex].position;
    return Vec3{x, y, z};
  };
  std::set<std::array<std::array<float, 3>, 3>> known;
  Surface surface;
  for (const auto& [a, b, c] : mesh.triangles) {
    std::array<std::array<float, 3>, 3> corners = {
        mesh.vertices[a].position, mesh.vertices[b].position, mesh.vertices[c].position};
    std::ranges::sort(corners);
    const Triangle triangle = {place(a), place(b), place(c)};
    if (norm(cross(triangle[1] - triangle[0], triangle[2] - triangle[0])) > 0.0 &&
        known.insert(corners).second)
      surface.push_back(triangle);
  }
  return surface;
}

/// The parts of a surface, in the order of their first triangles.
std::vector<Surface> connected(const Surface& surface) {
  std::vector<std::size_t> parent(surface.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& [edge, triangles] : edges_of(surface))
    if (triangles.size() == 2) parent[root(triangles[0])] = root(triangles[1]);
  std::map<std::size_t, std::size_t> part_of;
  std::vector<Surface> parts;
  for (std::size_t t = 0; t < surface.size(); ++t) {
    const auto [part, is_new] = part_of.try_emplace(root(t), parts.size());
    if (is_new) parts.emplace_back();
    parts[part->second].push_back(surface[t]);
  }
  return parts;
}

struct Bounds {
  Vec3 low, high;
  explicit Bounds(const Surface& surface) : low(surface[0][0]), high(low) {
    for (const Triangle& triangle : surface)
      for (const Vec3& p : triangle) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      }
  }
  bool holds(const Bounds& other) const {
    return low.x < other.low.x && low.y < other.low.y && low.z < other.low.z &&
           high.x > other.high.x && high.y > other.high.y && high.z > other.high.z;
  }
};

std::vector<Vec3> corners_of(const Surface& surface) {
  std::vector<Vec3> corners;
  for (const Triangle& triangle : surface)
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  return distinct(std::move(corners));
}

}  // namespace

CollisionPieces collision_pieces(const raster::Mesh& mesh) {
  constexpr double kFinest_m = 0.01;
  const Surface whole = triangles_of(mesh);
  CollisionPieces as_one{.corners = {corners_of(whole)}};
  // Of larger ones, nobody meant the pieces, and finding them takes long.
  if (whole.empty() || whole.size() > kMostTrianglesInPieces) return as_one;
  const std::vector<Surface> parts = connected(whole);
  // A wall around a room is a solid and, inside of it, one that is inside out.
  std::vector<Bounds> rooms;
  for (const Surface& part : parts)
    if (signed_volume_m3(part) < 0.0) rooms.emplace_back(part);
  CollisionPieces pieces{.corners = {}, .tolerance_m = kFinest_m};
  std::vector<ConvexPatches> divided;
  for (const Surface& part : parts) {
    const Bounds around(part);
    const auto is_in = [&](const Bounds& room) { return around.holds(room); };
    if (is_convex_solid(part) && std::ranges::none_of(rooms, is_in))
      pieces.corners.push_back(corners_of(part));
    else
      divided.emplace_back(part);
  }
  const Bounds all(whole);
  const double most_m = 0.25 * norm(all.high - all.low);
  for (double tolerance_m = kFinest_m;; tolerance_m *= 2.0) {
    std::size_t count = pieces.corners.size();
    for (ConvexPatches& part : divided) {
      part.join(tolerance_m);
      count += part.size();
    }
    pieces.tolerance_m = tolerance_m;
    if (count <= kMostPieces) break;
    if (tolerance_m > most_m) return as_one;
  }
  for (const ConvexPatches& part : divided)
    for (std::vector<Vec3>& points : part.points()) pieces.corners.push_back(std::move(points));
  return pieces;
}

std::optional<BoxPiece> as_box(const std::vector<Vec3>& corners) {
  constexpr double kSame = 1e-5, kThinnest_m = 0.015;
  std::vector<Vec3> places = distinct(corners);
  if (places.size() != 8) return std::nullopt;
  const Vec3 origin = places.front();
  // From one corner, the nearest others that are square to each other are along the edges.
  std::ranges::sort(places, {}, [&](const Vec3& p) { return norm(p - origin); });
  std::vector<Vec3> edges;
  for (const Vec3& p : places) {
    const Vec3 edge = p - origin;
    const auto is_square = [&](const Vec3& other) {
      return std::abs(dot(edge, other)) <= kSame * norm(edge) * norm(other);
    };
    if (norm(edge) > 0.0 && edges.size() < 3 && std::ranges::all_of(edges, is_square))
      edges.push_back(edge);
  }
  if (edges.size() < 3 || norm(edges[0]) < kThinnest_m) return std::nullopt;
  const double same_m = kSame * norm(edges[2]);
  for (unsigned i = 0; i < 8; ++i) {
    Vec3 corner = origin;
    for (unsigned k = 0; k < 3; ++k)
      if ((i >> k & 1U) != 0) corner = corner + edges[k];
    const auto is_there = [&](const Vec3& p) { return norm(p - corner) <= same_m; };
    if (std::ranges::none_of(places, is_there)) return std::nullopt;
  }
  if (dot(cross(edges[0], edges[1]), edges[2]) < 0.0) std::swap(edges[0], edges[1]);
  const auto along = [&](std::size_t k) { return (1.0 / norm(edges[k])) * edges[k]; };
  const uav::Quat to_z = rotation_from_z(along(2));
  const Vec3 x = rotate(inverse(to_z), along(0));
  const double half_cos = std::sqrt(std::max(0.0, 0.5 * (1.0 + x.x)));
  const uav::Quat about_z = half_cos > kSame ? uav::Quat{half_cos, 0.0, 0.0, 0.5 * x.y / half_cos}
                                             : uav::Quat{0, 0, 0, 1};
  return BoxPiece{{norm(edges[0]), norm(edges[1]), norm(edges[2])},
                  {origin + 0.5 * (edges[0] + edges[1] + edges[2]), normalized(to_z * about_z)}};
}

std::vector<Vec3> with_volume(const std::vector<Vec3>& points) {
  const std::vector<Vec3> shifts = thickness_of(points);
  if (shifts.empty()) return points;
  std::vector<Vec3> thick;
  for (const Vec3& p : points)
    for (const Vec3& shift : shifts) thick.push_back(p + shift);
  return thick;
}

}  // namespace tether::sim
