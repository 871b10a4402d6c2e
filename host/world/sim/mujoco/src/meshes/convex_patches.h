#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include <tether/uav/math.h>

namespace tether::sim {

/// Of what has no thickness of its own: so far on both sides of it.
inline constexpr double kHalfThickness_m = 1e-3;

/// The corners of a triangle, counter-clockwise as seen from outside.
using Triangle = std::array<uav::Vec3, 3>;

/// A surface whose triangles share edges, each with at most one other.
using Surface = std::vector<Triangle>;

/// The ends of an edge, in the order of x, y, z.
using MeshEdge = std::pair<uav::Vec3, uav::Vec3>;
struct MeshEdgeOrder {
  bool operator()(const MeshEdge& a, const MeshEdge& b) const;
};

/// The triangles at each edge.
std::map<MeshEdge, std::vector<std::size_t>, MeshEdgeOrder> edges_of(const Surface& triangles);

/// Whether the surface is closed, convex and not inside out: then its convex hull is its solid. Of
/// which triangles the corners are in the wrong order does not matter, unless they are all: a room.
bool is_convex_solid(const Surface& surface);

/// The volume that the surface encloses [m³]; negative if it is inside out, as a room is.
double signed_volume_m3(const Surface& surface);

/// Divides a surface into patches that are flat and convex up to a tolerance. The hull of a patch
/// covers nothing that is not the surface: a UAV can fly inside of a room and through its door.
///
/// From each triangle on, the two neighbours are joined whose hull leaves the least gap, as Hertel
/// and Mehlhorn (1983) join the triangles of a polygon, for as long as any two may be joined.
class ConvexPatches {
 public:
  explicit ConvexPatches(const Surface& surface);

  /// Joins patches for as long as the corners of each are within `tolerance_m` of a plane, and the
  /// gaps in its hull are not wider than about that.
  void join(double tolerance_m);

  std::size_t size() const { return alive_; }
  /// What the hull of each is made of: its corners, 1 mm before and 1 mm behind the surface.
  std::vector<std::vector<uav::Vec3>> points() const;

 private:
  struct Patch {
    std::vector<uav::Vec3> points;
    uav::Vec3 area_vector_m2;  ///< along the normal
    double area_m2 = 0.0;
    std::vector<std::size_t> neighbours{};
    bool is_alive = true;
  };
  struct Joined {
    Patch patch;
    double gap_m = 0.0;
  };

  Joined joined(const Patch& a, const Patch& b, double tolerance_m) const;

  std::vector<Patch> patches_;
  std::size_t alive_ = 0;
};

}  // namespace tether::sim
