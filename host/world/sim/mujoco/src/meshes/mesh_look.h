#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <tether/base/error.h>
#include <tether/sim/world.h>
#include <tether/sim_raster/scene.h>

struct aiMaterial;
struct aiMesh;
struct aiScene;

namespace tether::sim {

/// How a mesh file says that a part of it looks.
struct MeshLook {
  Material material;  ///< ambient is diffuse; its `albedo_map` is one of the mesh's companions
  std::shared_ptr<const raster::Texture> picture{};  ///< in place of `albedo_map`: in the file
};

/// The look of one of the materials of Assimp's scene of `mesh.file`. Of pictures, the one of the
/// surface's colour is taken; an alpha of 0 is taken for a mistake of the program that wrote it.
/// Warns of a picture that is not among the companions or cannot be read.
MeshLook read_look(const aiScene& scene, const aiMaterial& material, const MeshGeometry& mesh,
                   const WarningSink& warn);

/// Whether vertices give a mesh its colours: only where its material has no picture, and where the
/// format has no materials or says so (glTF). Gazebo ignores those of other files.
bool has_vertex_colours(const aiScene& scene, const aiMesh& mesh,
                        const std::filesystem::path& file);
/// Colours of vertices are drawn by one picture that has every colour, 64 steps for each of red,
/// green and blue: a triangle is where its mean colour is.
std::shared_ptr<const raster::Texture> palette();
std::array<float, 2> place_in_palette(const aiMesh& mesh, std::span<const unsigned> corners);

/// What of a library of materials of OBJ files (.mtl) is used: Assimp reads beyond its own memory
/// in libraries with other lines.
std::string clean_library(const std::string& text);

/// The companion that a mesh's text means: the one of that file name, whatever the folder and the
/// case of its letters; nullptr if there is none.
const std::filesystem::path* find_companion(const MeshGeometry& mesh, std::string_view text);

}  // namespace tether::sim
