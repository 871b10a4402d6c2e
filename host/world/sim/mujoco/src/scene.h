#pragma once

#include "meshes/mesh_file.h"

#include <optional>

#include <tether/sim/file_cache.h>
#include <tether/sim/world.h>
#include <tether/sim_raster/scene.h>

namespace tether::sim {

/// The world's visuals and lights for the renderer. An instance's body is one of `moving_bodies`,
/// or one of `turned_parts` after them; its entity is the number of its model, from 1 on: the
/// world's models, then the UAVs. Finds the textures in the cache, or keeps them there.
///
/// Warns of lights beyond the 32nd, of point lights that should cast shadows, of damaged textures,
/// of textures that are halved because all have too many pixels, and of those that cannot be read,
/// unless the world is read strictly.
/// @throws Error(kBadFile) where the world names a mesh that cannot be read, or with which the
/// scene has more triangles than the renderer takes; of a strict world, a texture that cannot be
/// read.
raster::SceneParts make_scene(const World& world, const WarningSink& warn,
                              const MeshFiles& meshes = MeshFiles(),
                              const std::optional<FileCache>& cache = std::nullopt);

}  // namespace tether::sim
