#pragma once

#include "meshes/mesh_look.h"
#include "meshes/mesh_pieces.h"
#include "meshes/triangle_mesh.h"

#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include <tether/sim/world.h>

namespace tether::sim {

/// What of a mesh file looks the same.
struct MeshPart {
  raster::Mesh mesh;
  MeshLook look;
};

/// Reads mesh files, each once, and keeps what is in them. One thread at a time.
class MeshFiles {
 public:
  MeshFiles();
  ~MeshFiles();
  MeshFiles(MeshFiles&&) noexcept;
  MeshFiles& operator=(MeshFiles&&) noexcept;

  /// The triangles of an OBJ, STL, COLLADA or glTF file, scaled, in the file's own axes (an "up"
  /// axis is not applied, as in Gazebo). Keeps the file's texture coordinates; where it has none,
  /// the texture is projected along the main axis of each face. No other file is opened than the
  /// mesh's companions, whatever this one names.
  /// @throws Error(kBadFile) with the file, about the submesh, if the file cannot be read, is
  /// larger than 512 MiB, has no such submesh, no triangle with an area, a number that is not
  /// finite or too large, a face of more than 1000 corners, or more triangles than the renderer
  /// takes.
  raster::Mesh load(const MeshGeometry& mesh, const TextureScale& scale) const;

  /// The same triangles, by the materials of the file, with how each looks. A surface that is seen
  /// from both sides has each triangle twice.
  /// @throws Error(kBadFile) as `load`.
  std::vector<MeshPart> parts(const MeshGeometry& mesh, const WarningSink& warn) const;

  /// Where the mesh has vertices, each place once, in the order of x, y, z: what its convex hull
  /// is made of. A flat mesh, which has no hull, gets a thickness of 2 mm.
  /// @throws Error(kBadFile) as `load`, and for more than 1,000,000.
  std::vector<uav::Vec3> corners(const MeshGeometry& mesh) const;

  /// The convex pieces of the whole mesh; `MeshGeometry::piece` selects one of them for `corners`.
  const CollisionPieces& pieces(const MeshGeometry& any) const;

 private:
  struct Imported;
  const aiScene& imported(const MeshGeometry& mesh) const;

  mutable std::map<std::filesystem::path, std::unique_ptr<Imported>> files_;
  mutable std::map<MeshKey, CollisionPieces> pieces_;
};

}  // namespace tether::sim
