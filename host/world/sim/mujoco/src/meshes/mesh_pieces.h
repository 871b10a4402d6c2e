#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <tether/sim_raster/scene.h>
#include <tether/uav/math.h>

namespace tether::sim {

inline constexpr std::size_t kMostPieces = 1000;

/// What a mesh collides as.
struct CollisionPieces {
  /// Where the corners of each piece are. The convex hulls of all pieces are the mesh, up to
  std::vector<std::vector<uav::Vec3>> corners;
  double tolerance_m = 0.0;  ///< None: its own convex hull, as the only piece.
};

/// Divides a mesh into convex pieces: its solid parts that are convex, as they are; of anything
/// else (a room, a house with doors, a sheet), the patches of its surface. A part is what is
/// connected by edges of two triangles: two boxes that touch are two parts.
///
/// A patch is within 1 cm of the mesh, or as much more as makes at most `kMostPieces`. A mesh of
/// more than 300,000 triangles, or with more solid parts than that, is one piece.
CollisionPieces collision_pieces(const raster::Mesh& mesh);

/// The box that eight corners are, if they are one that is thicker than a patch; its origin is its
/// middle. Contacts with it are found more exactly than with any other solid.
struct BoxPiece {
  uav::Vec3 size_m;
  uav::Pose X_MB;  ///< in the frame of the mesh
};
std::optional<BoxPiece> as_box(const std::vector<uav::Vec3>& corners);

/// The points, each once, in the order of x, y, z.
std::vector<uav::Vec3> distinct(std::vector<uav::Vec3> points);

/// The points; if their hull is flat, without a volume, they are 1 mm on both sides of it.
std::vector<uav::Vec3> with_volume(const std::vector<uav::Vec3>& points);

}  // namespace tether::sim
