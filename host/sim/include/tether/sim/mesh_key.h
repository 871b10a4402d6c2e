#pragma once

#include <filesystem>
#include <string>
#include <tuple>

#include <tether/sim/world.h>

namespace tether::sim {

/// What distinguishes two uses of meshes: file, submesh, scale, and whether it is centered.
using MeshKey = std::tuple<std::filesystem::path, std::string, double, double, double, bool>;

inline MeshKey key_of(const MeshGeometry& mesh) {
  return {mesh.file, mesh.submesh, mesh.scale.x, mesh.scale.y, mesh.scale.z, mesh.is_centered};
}

}  // namespace tether::sim
