#include "meshes/convex_patches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <tuple>
#include <utility>

namespace tether::sim {
namespace {

using uav::Vec3;

constexpr double kNever = std::numeric_limits<double>::infinity();

std::tuple<double, double, double> in_order(const Vec3& p) {
  return {p.x, p.y, p.z};
}

bool is_before(const Vec3& a, const Vec3& b) {
  return in_order(a) < in_order(b);
}

Vec3 area_vector_m2(const Triangle& t) {
  return 0.5 * cross(t[1] - t[0], t[2] - t[0]);
}

/// A corner in a plane, and where it is in space.
struct Flat {
  double u, v;
  Vec3 p;
};

double turn(const Flat& a, const Flat& b, const Flat& c) {
  return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

/// The convex hull in the plane, counter-clockwise: the algorithm of Andrew (1979).
std::vector<Flat> hull_of(std::vector<Flat> corners) {
  std::ranges::sort(corners, {}, [](const Flat& f) { return std::pair(f.u, f.v); });
  std::vector<Flat> hull;
  const auto add = [&hull](const Flat& corner, std::size_t first) {
    while (hull.size() >= first + 2 && turn(hull[hull.size() - 2], hull.back(), corner) <= 0.0)
      hull.pop_back();
    hull.push_back(corner);
  };
  for (const Flat& corner : corners) add(corner, 0);
  const std::size_t upper = hull.size() - 1;
  for (std::size_t i = corners.size() - 1; i-- > 0;) add(corners[i], upper);
  if (hull.size() > 1) hull.pop_back();
  return hull;
}

double area_m2(const std::vector<Flat>& hull) {
  double twice_m2 = 0.0;
  for (std::size_t i = 1; i + 1 < hull.size(); ++i) twice_m2 += turn(hull[0], hull[i], hull[i + 1]);
  return 0.5 * twice_m2;
}

std::pair<Vec3, Vec3> across(const Vec3& normal) {
  const Vec3 other = std::abs(normal.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 along = cross(normal, other);
  const Vec3 u = (1.0 / norm(along)) * along;
  return {u, cross(normal, u)};
}

}  // namespace

bool MeshEdgeOrder::operator()(const MeshEdge& a, const MeshEdge& b) const {
  return std::pair(in_order(a.first), in_order(a.second)) <
         std::pair(in_order(b.first), in_order(b.second));
}

std::map<MeshEdge, std::vector<std::size_t>, MeshEdgeOrder> edges_of(const Surface& triangles) {
  std::map<MeshEdge, std::vector<std::size_t>, MeshEdgeOrder> edges;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      edges[std::minmax(triangles[t][i], triangles[t][(i + 1) % 3], is_before)].push_back(t);
  return edges;
}

double signed_volume_m3(const Surface& surface) {
  double six_m3 = 0.0;
  for (const Triangle& t : surface)
    six_m3 += dot(t[0] - surface[0][0], cross(t[1] - surface[0][0], t[2] - surface[0][0]));
  return six_m3 / 6.0;
}

bool is_convex_solid(const Surface& surface) {
  constexpr double kTolerance = 1e-3;  // of the length of the surface
  for (const auto& [edge, triangles] : edges_of(surface))
    if (triangles.size() != 2) return false;
  std::vector<Vec3> corners;
  for (const Triangle& t : surface) corners.insert(corners.end(), t.begin(), t.end());
  std::ranges::sort(corners, is_before);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  double length_m = 0.0;
  for (const Vec3& p : corners) length_m = std::max(length_m, norm(p - corners.front()));
  bool is_room = true;
  for (const Triangle& t : surface) {
    const Vec3 area = area_vector_m2(t);
    const double most = kTolerance * length_m * norm(area);
    double before = 0.0, behind = 0.0;
    for (const Vec3& p : corners) {
      before = std::max(before, dot(area, p - t[0]));
      behind = std::max(behind, -dot(area, p - t[0]));
      if (before > most && behind > most) return false;
    }
    is_room = is_room && before > behind;
  }
  return !is_room;
}

ConvexPatches::ConvexPatches(const Surface& surface) : alive_(surface.size()) {
  for (const Triangle& t : surface) {
    const Vec3 area = area_vector_m2(t);
    patches_.push_back({{t.begin(), t.end()}, area, norm(area)});
  }
  for (const auto& [edge, triangles] : edges_of(surface)) {
    if (triangles.size() != 2) continue;
    patches_[triangles[0]].neighbours.push_back(triangles[1]);
    patches_[triangles[1]].neighbours.push_back(triangles[0]);
  }
}

ConvexPatches::Joined ConvexPatches::joined(const Patch& a, const Patch& b,
                                            double tolerance_m) const {
  Joined out{.patch = {}, .gap_m = kNever};
  // Whoever made the mesh may have turned one of them.
  const double sign = dot(a.area_vector_m2, b.area_vector_m2) < 0.0 ? -1.0 : 1.0;
  out.patch.area_vector_m2 = a.area_vector_m2 + sign * b.area_vector_m2;
  out.patch.area_m2 = a.area_m2 + b.area_m2;
  const double length = norm(out.patch.area_vector_m2);
  if (length <= 0.0) return out;
  const Vec3 normal = (1.0 / length) * out.patch.area_vector_m2;
  const auto [u, v] = across(normal);
  std::vector<Flat> corners;
  const Vec3 origin = a.points.front();
  for (const Patch* patch : {&a, &b})
    for (const Vec3& p : patch->points)
      corners.push_back({dot(u, p - origin), dot(v, p - origin), p});
  const auto height_m = [&](const Flat& corner) { return dot(normal, corner.p - origin); };
  const auto [low, high] = std::ranges::minmax_element(corners, {}, height_m);
  if (height_m(*high) - height_m(*low) > tolerance_m) return out;
  const Vec3 lowest = low->p, highest = high->p;
  const std::vector<Flat> hull = hull_of(std::move(corners));
  const double hull_m2 = area_m2(hull);
  const double gap_m2 = std::max(0.0, hull_m2 - out.patch.area_m2);
  // As wide as the gap would be, if it were as long as the patch.
  const double gap_m = hull_m2 > 0.0 ? gap_m2 / std::sqrt(hull_m2) : 0.0;
  if (gap_m > tolerance_m) return out;
  out.gap_m = gap_m;
  std::vector<Vec3>& points = out.patch.points;
  points = {lowest, highest};
  for (const Flat& corner : hull) points.push_back(corner.p);
  std::ranges::sort(points, is_before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return out;
}

void ConvexPatches::join(double tolerance_m) {
  // The smaller gap first, then the smaller patch.
  using Pair = std::tuple<double, double, std::size_t, std::size_t>;
  std::priority_queue<Pair, std::vector<Pair>, std::greater<>> pairs;
  const auto consider = [&](std::size_t i, std::size_t j) {
    const Joined both = joined(patches_[i], patches_[j], tolerance_m);
    if (both.gap_m < kNever) pairs.emplace(both.gap_m, both.patch.area_m2, i, j);
  };
  for (std::size_t i = 0; i < patches_.size(); ++i)
    for (const std::size_t j : patches_[i].neighbours)
      if (patches_[i].is_alive && patches_[j].is_alive && i < j) consider(i, j);
  while (!pairs.empty()) {
    const auto [gap_m, area, i, j] = pairs.top();
    pairs.pop();
    if (!patches_[i].is_alive || !patches_[j].is_alive) continue;
    Patch patch = joined(patches_[i], patches_[j], tolerance_m).patch;
    const std::size_t own = patches_.size();
    for (const std::size_t old : {i, j}) {
      for (const std::size_t other : patches_[old].neighbours)
        if (other != i && other != j && patches_[other].is_alive) patch.neighbours.push_back(other);
      patches_[old] = {.points = {}, .area_vector_m2 = {}, .is_alive = false};
    }
    std::ranges::sort(patch.neighbours);
    patch.neighbours.erase(std::unique(patch.neighbours.begin(), patch.neighbours.end()),
                           patch.neighbours.end());
    for (const std::size_t other : patch.neighbours) patches_[other].neighbours.push_back(own);
    patches_.push_back(std::move(patch));
    --alive_;
    for (const std::size_t other : std::vector<std::size_t>(patches_[own].neighbours))
      consider(own, other);
  }
}

std::vector<std::vector<Vec3>> ConvexPatches::points() const {
  std::vector<std::vector<Vec3>> all;
  for (const Patch& patch : patches_) {
    if (!patch.is_alive) continue;
    const Vec3 shift = (kHalfThickness_m / norm(patch.area_vector_m2)) * patch.area_vector_m2;
    std::vector<Vec3>& thick = all.emplace_back();
    for (const Vec3& p : patch.points) {
      thick.push_back(p - shift);
      thick.push_back(p + shift);
    }
  }
  return all;
}

}  // namespace tether::sim
