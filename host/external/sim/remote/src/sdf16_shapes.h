#pragma once

#include <string>
#include <vector>

#include <tether/sim/world.h>

namespace tether::sim {

/// A UAV's visuals and collisions in the shapes of SDF 1.6 only, with unique names without "::". A
/// capsule becomes a cylinder and two spheres; an ellipsoid becomes a sphere of the same volume,
/// with a warning.
std::vector<Visual> sdf16_visuals(const Uav& uav, const WarningSink& warn);
std::vector<Collision> sdf16_collisions(const Uav& uav, const WarningSink& warn);

}  // namespace tether::sim
