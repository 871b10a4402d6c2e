#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <tuple>

#include <tether/sim/world.h>

namespace tether::sim {

/// What distinguishes two uses of meshes: file, submesh, scale, whether it is centered, and piece.
using MeshKey = std::tuple<std::filesystem::path, std::string, double, double, double, bool,
                           std::optional<std::size_t>>;

inline MeshKey key_of(const MeshGeometry& mesh) {
  return {mesh.file,    mesh.submesh,     mesh.scale.x, mesh.scale.y,
          mesh.scale.z, mesh.is_centered, mesh.piece};
}

}  // namespace tether::sim
