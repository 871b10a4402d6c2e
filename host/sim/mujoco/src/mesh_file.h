#pragma once

#include "triangle_mesh.h"

#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include <tether/sim/mesh_key.h>
#include <tether/sim/world.h>

namespace Assimp {
class Importer;
}

namespace tether::sim {

/// Reads mesh files, each once, and keeps what is in them. One thread at a time.
class MeshFiles {
 public:
  MeshFiles();
  ~MeshFiles();
  MeshFiles(MeshFiles&&) noexcept;
  MeshFiles& operator=(MeshFiles&&) noexcept;

  /// The triangles of an OBJ, STL or COLLADA file, scaled, in the file's own axes (a COLLADA "up"
  /// axis is not applied, as in Gazebo). Keeps the file's texture coordinates; where it has none,
  /// the texture is projected along the main axis of each face. The file's own materials are not
  /// used; several ones cause a warning. No other file is opened, whatever this one names.
  /// @throws Error(kBadFile) with the file, about the submesh, if the file cannot be read, is
  /// larger than 512 MiB, has no such submesh, no triangle with an area, a number that is not
  /// finite or too large, a face of more than 1000 corners, or more triangles than the renderer
  /// takes.
  raster::Mesh load(const MeshGeometry& mesh, const TextureScale& scale,
                    const WarningSink& warn) const;

  /// Where the mesh has vertices, each place once, in the order of x, y, z: what its convex hull
  /// is made of.
  /// @throws Error(kBadFile) as `load`, and for more than 1,000,000.
  std::vector<uav::Vec3> corners(const MeshGeometry& mesh) const;

 private:
  const Assimp::Importer& imported(const std::filesystem::path& file) const;

  mutable std::map<std::filesystem::path, std::unique_ptr<Assimp::Importer>> files_;
};

}  // namespace tether::sim
