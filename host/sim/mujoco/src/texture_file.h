#pragma once

#include "engine.h"

#include <filesystem>
#include <string>

namespace tether::sim {

/// A PNG or JPEG file as the engine reads textures: PNG as it is, JPEG decoded into the engine's
/// own format. `name` gets the extension by which the engine tells them apart.
/// @throws Error(kBadFile) with the file if it cannot be read or is not a JPEG image of up to
/// 16384 pixels an edge.
ModelFile texture_file(const std::string& name, const std::filesystem::path& file);

}  // namespace tether::sim
