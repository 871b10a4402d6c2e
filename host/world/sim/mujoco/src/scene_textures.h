#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <tether/base/error.h>
#include <tether/sim/file_cache.h>
#include <tether/sim_raster/scene.h>

namespace tether::sim {

/// Where the pixels of a texture are.
struct TextureSource {
  std::filesystem::path file;  ///< PNG or JPEG
  FileLocation named_at;       ///< where the world names the file; empty: in no file
  std::shared_ptr<const raster::Texture> picture{};  ///< that is in the file of a mesh
};

/// Reads the textures that the materials of `parts` number as in `sources`; finds them in the
/// cache, or keeps them there. Of more pixels than the renderer takes, the largest textures are
/// halved.
///
/// Warns of those that are damaged, halved, or cannot be read, which materials then lack.
/// @throws Error(kBadFile) for one that cannot be read, if `is_strict`.
void add_textures(const std::vector<TextureSource>& sources, bool is_strict,
                  const WarningSink& warn, const std::optional<FileCache>& cache,
                  raster::SceneParts& parts);

}  // namespace tether::sim
