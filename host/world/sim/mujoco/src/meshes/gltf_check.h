#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace tether::sim {

/// Refuses glTF files, binary or not, that Assimp must not get: it allocates whatever size a file
/// names.
/// @param most_bytes the size of the file and of its companions together
/// @throws Error(kBadFile) with `file` if the content is not glTF's JSON, is nested deeper than 64,
/// or has a size, an offset or a count beyond `most_bytes`.
void check_gltf(std::string_view content, std::uintmax_t most_bytes,
                const std::filesystem::path& file);

}  // namespace tether::sim
