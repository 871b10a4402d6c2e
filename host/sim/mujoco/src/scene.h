#pragma once

#include "mesh_file.h"

#include <tether/sim/world.h>
#include <tether/sim_raster/scene.h>

namespace tether::sim {

/// The world's visuals and lights for the renderer. An instance's body is one of `moving_bodies`;
/// its entity is the number of its model, from 1 on: the world's models, then the UAVs.
///
/// Warns of lights beyond the 32nd, of point lights that should cast shadows, and of damaged
/// textures.
/// @throws Error(kBadFile) where the world names a mesh or texture that cannot be read, or with
/// which the scene has more triangles or pixels of textures than the renderer takes.
raster::SceneParts make_scene(const World& world, const WarningSink& warn,
                              const MeshFiles& meshes = MeshFiles());

}  // namespace tether::sim
