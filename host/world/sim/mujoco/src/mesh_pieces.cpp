#include "mesh_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace tether::sim {
namespace {

using uav::Vec3;

constexpr std::size_t kMostTrianglesInPieces = 300'000;

// Whether points lie in a plane: no convex hull is found for them. @pre There are points.
bool is_flat(const std::vector<Vec3>& points) {
  constexpr double kFlat = 1e-6;  // of their length
  const auto most = [&](const auto& measure) {
    return *std::ranges::max_element(points, {}, measure);
  };
  const Vec3 a = points.front();
  const Vec3 b = most([&](const Vec3& p) { return norm(p - a); });
  const Vec3 c = most([&](const Vec3& p) { return norm(cross(b - a, p - a)); });
  const Vec3 normal = cross(b - a, c - a);
  const auto volume_m3 = [&](const Vec3& p) { return std::abs(dot(normal, p - a)); };
  const double length_m = norm(b - a);
  return norm(normal) <= kFlat * length_m * length_m ||
         volume_m3(most(volume_m3)) <= kFlat * length_m * norm(normal);
}

// With a small cube around each point.
std::vector<Vec3> thickened(const std::vector<Vec3>& points) {
  constexpr double kHalf_m = 1e-3;
  std::vector<Vec3> thick;
  for (const Vec3& p : points)
    for (int i = 0; i < 8; ++i)
      thick.push_back(p + Vec3{(i & 1) != 0 ? kHalf_m : -kHalf_m, (i & 2) != 0 ? kHalf_m : -kHalf_m,
                               (i & 4) != 0 ? kHalf_m : -kHalf_m});
  return thick;
}

}  // namespace

std::vector<std::vector<Vec3>> connected_pieces(const raster::Mesh& mesh) {
  using Corner = std::array<float, 3>;
  std::map<std::pair<Corner, Corner>, std::vector<std::size_t>> edges;
  std::vector<std::size_t> parent(mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto place = [&](std::size_t triangle, std::size_t corner) -> const Corner& {
    return mesh.vertices[mesh.triangles[triangle][corner % 3]].position;
  };
  // Of large meshes, nobody meant the pieces, and finding them takes long.
  const bool is_whole = parent.size() > kMostTrianglesInPieces;
  if (is_whole) std::ranges::fill(parent, std::size_t{0});
  for (std::size_t t = 0; t < parent.size() && !is_whole; ++t)
    for (std::size_t i = 0; i < 3; ++i)
      edges[std::minmax(place(t, i), place(t, i + 1))].push_back(t);
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& [edge, triangles] : edges)
    if (triangles.size() == 2) parent[root(triangles[0])] = root(triangles[1]);
  std::map<std::size_t, std::set<Corner>> places;
  for (std::size_t t = 0; t < parent.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) places[root(t)].insert(place(t, i));
  std::set<std::set<Corner>> in_order;
  for (auto& [number, corners] : places) in_order.insert(std::move(corners));
  std::vector<std::vector<Vec3>> pieces;
  for (const std::set<Corner>& corners : in_order) {
    pieces.emplace_back();
    for (const auto& [x, y, z] : corners) pieces.back().push_back({x, y, z});
  }
  return pieces;
}

std::vector<Vec3> with_volume(const std::vector<Vec3>& points) {
  return is_flat(points) ? thickened(points) : points;
}

}  // namespace tether::sim
