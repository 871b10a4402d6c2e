#pragma once

#include <filesystem>
#include <string>

namespace tether::sim {

/// Refuses COLLADA files that Assimp must not get: it follows nodes that contain themselves until
/// its stack is full, multiplies nodes without a limit, and unpacks archives.
/// @throws Error(kBadFile) with `file` and the line, if `text` is not XML, nested deeper than 100
/// elements, or has nodes within nodes deeper than 200 or more than 100,000 of them.
///
/// Changes what Assimp refuses: comments, blanks before colours, and images without a file.
void check_collada(std::string& text, const std::filesystem::path& file);

}  // namespace tether::sim
