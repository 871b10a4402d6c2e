#pragma once

#include "meshes/mesh_file.h"

#include <tether/sim/world.h>

namespace tether::sim {

/// Leaves out the visuals and collisions of models whose mesh cannot be used, with a warning each,
/// unless the world is read strictly: then make_scene and make_physics_model refuse them.
void leave_out_unusable_meshes(World& world, const MeshFiles& meshes, const WarningSink& warn);

/// Replaces each collision of a model by one for each convex piece of its mesh, so that a UAV can
/// fly between them: inside of a room, through a gate.
void split_collisions(World& world, const MeshFiles& meshes);

}  // namespace tether::sim
