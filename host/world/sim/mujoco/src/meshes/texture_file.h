#pragma once

#include <filesystem>
#include <string_view>

#include <tether/base/error.h>
#include <tether/sim_raster/scene.h>

namespace tether::sim {

/// Reads a PNG or JPEG picture; its first bytes say which. Warns of a damaged JPEG picture.
/// @throws Error(kBadFile) with the file if it cannot be read or is larger than the renderer takes.
raster::Texture load_texture(const std::filesystem::path& file, const WarningSink& warn);
/// The same of the picture that `file` has in it.
raster::Texture decode_texture(std::string_view bytes, const std::filesystem::path& file,
                               const WarningSink& warn);

}  // namespace tether::sim
