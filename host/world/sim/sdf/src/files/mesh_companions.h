#pragma once

#include <filesystem>
#include <vector>

namespace tether::sim {

/// The files that a mesh file names as parts of it: pictures (PNG, JPEG), libraries of materials
/// (.mtl) with their pictures, and buffers (.bin). Absolute, each once. They are searched for by
/// their names in the mesh's folder, its subfolders, the folder above, and the folders of textures
/// that models have (../textures, ../materials/textures and the same one folder higher): programs
/// write paths that were only valid on the machine of the author.
/// @throws Error(kBadFile) if the mesh cannot be read.
std::vector<std::filesystem::path> mesh_companions(const std::filesystem::path& mesh);

}  // namespace tether::sim
