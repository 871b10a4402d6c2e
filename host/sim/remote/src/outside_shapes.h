#pragma once

#include <string>
#include <vector>

#include <tether/sim/world.h>

namespace tether::sim {

/// A UAV's visuals and collisions with only such shapes as SDF 1.6 has, and names that are unique
/// and free of "::". A capsule becomes a cylinder and two spheres, an ellipsoid a sphere of the
/// same volume (which `warn` is told).
std::vector<Visual> outside_visuals(const Uav& uav, const WarningSink& warn);
std::vector<Collision> outside_collisions(const Uav& uav, const WarningSink& warn);

}  // namespace tether::sim
