#pragma once

#include <span>

#include <tether/sim/world.h>

namespace tether::sim {

/// A convex shape at a pose. It is a core, which is described by its support points, with
/// everything within `rounding_m` of it.
struct Convex {
  const Geometry& geometry;             ///< not a plane
  std::span<const uav::Vec3> vertices;  ///< of a mesh
  uav::Pose X_WS;
};

/// The point of the core that is farthest in the direction `d_W`, in W.
uav::Vec3 support_point(const Convex& shape, const uav::Vec3& d_W);
double rounding_m(const Convex& shape);

/// The distance between two shapes; 0 if they meet. The algorithm of Gilbert, Johnson and Keerthi
/// (1988), exact to about 1e-6 of the distance.
double distance_m(const Convex& a, const Convex& b);

}  // namespace tether::sim
