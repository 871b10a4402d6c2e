#pragma once

#include "triangle_mesh.h"

namespace tether::sim {

/// Reads an OBJ, STL or COLLADA file, scaled, in the file's own axes (a COLLADA "up" axis is not
/// applied, as in Gazebo). Keeps the file's texture coordinates; where it has none, the texture is
/// projected along the main axis of each face. The file's own materials are not used; several ones
/// cause a warning.
/// @throws Error(kBadFile) with the file, about the submesh, if the file cannot be read or has no
/// such submesh, no triangle, or more than the renderer takes.
raster::Mesh load_mesh(const MeshGeometry& mesh, const TextureScale& scale,
                       const WarningSink& warn);

}  // namespace tether::sim
