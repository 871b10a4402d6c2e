#pragma once

#include <filesystem>
#include <string_view>

namespace tether::sim {

/// Refuses what makes Assimp's reader of Wavefront files read beyond its memory: a face, line or
/// point (`f`, `l`, `p`) without corners, or with one that is no number.
/// @throws Error(kBadFile) with the file and line
void check_obj(std::string_view content, const std::filesystem::path& file);

}  // namespace tether::sim
