#pragma once

#include <tether/sim/world.h>
#include <tether/sim_raster/scene.h>

namespace tether::sim {

/// The world's visuals and lights for the renderer. An instance's body is one of `moving_bodies`;
/// its entity is the number of its model, from 1 on: the world's models, then the UAVs.
///
/// Warns of lights beyond the 32nd.
/// @throws Error(kBadFile) for a mesh or texture that cannot be read.
raster::SceneParts make_scene(const World& world, const WarningSink& warn);

}  // namespace tether::sim
