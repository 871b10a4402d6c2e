#pragma once

#include <vector>

#include <tether/sim_raster/scene.h>
#include <tether/uav/math.h>

namespace tether::sim {

/// The places of the corners of each piece of a mesh, in the order of x, y, z; so are the pieces.
/// Triangles are of one piece if they share an edge with each other only: two boxes that touch are
/// two pieces. A mesh of more than 300,000 triangles is one.
std::vector<std::vector<uav::Vec3>> connected_pieces(const raster::Mesh& mesh);

/// The points; if they lie in a plane, where no convex hull has a volume, with a cube of 2 mm
/// around each. @pre There are points.
std::vector<uav::Vec3> with_volume(const std::vector<uav::Vec3>& points);

}  // namespace tether::sim
