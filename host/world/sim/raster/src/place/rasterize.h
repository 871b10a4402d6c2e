#pragma once

#include "place/layer.h"
#include "place/lens.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace tether::raster {

/// A part of the picture: up to kTile_px each way. `x` is a multiple of it.
struct Tile {
  int x = 0, y = 0;
  int width = 0, height = 0;
};
inline PixelRect pixels_of(const Tile& t) {
  return {t.x, t.y, t.x + t.width - 1, t.y + t.height - 1};
}

/// For each pixel of a tile, the triangle that is seen there (0: none) and the reciprocal of its
/// depth.
struct TileIds {
  /// If not 0: all pixels see this triangle, the arrays are not set, and the tile has its full
  /// width.
  std::uint32_t everywhere = 0;
  alignas(64) std::array<std::uint32_t, kTilePixels + kMaxLanes> id;  ///< some more, to be read
  alignas(64) std::array<float, kTilePixels> inverse_depth;
};

/// The only one of `triangles` of which a tile's pixels may see anything, if it covers them all and
/// is nearer than `farthest_m`.
std::optional<std::uint32_t> find_only(const Layer& layer, const Lens& lens, const Tile& tile,
                                       std::span<const std::uint32_t> triangles, double farthest_m);

/// No triangle anywhere, as if at this depth.
void clear(double farthest_m, TileIds& ids);

/// What triangles are called in TileIds.
enum class Names {
  kPlaces,  ///< 1 + the place in the layer
  kKeys     ///< Layer::keys
};

inline std::uint32_t name_of(const Layer& layer, std::uint32_t triangle, Names names) {
  return names == Names::kKeys ? layer.keys[triangle] : triangle + 1;
}

/// Keeps, for each pixel, the nearest of `triangles` and of the present one; of equally near ones,
/// the first.
void rasterize_nearest(const Layer& layer, const Lens& lens, const Tile& tile,
                       std::span<const std::uint32_t> triangles, Names names, TileIds& ids);

/// Finds, for each pixel, the nearest of `triangles` that is before `behind` and behind `last`; of
/// equally near ones, the last, but before that of `last`. Names are places. `next` is set anew.
/// @returns whether there is any.
bool rasterize_next(const Layer& layer, const Lens& lens, const Tile& tile,
                    std::span<const std::uint32_t> triangles, const TileIds& behind,
                    const TileIds& last, TileIds& next);

}  // namespace tether::raster
