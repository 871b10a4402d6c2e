#pragma once

#include "place/layer.h"
#include "place/lens.h"
#include "place/rasterize.h"
#include "place/shadow_map.h"
#include "scene/prepared_scene.h"
#include "shade/light_table.h"
#include "shade/runs.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tether::raster {

/// The data of a picture that all of its tiles are shaded with.
struct Shading {
  const PreparedScene& scene;
  const Lens& lens;
  const std::vector<ShadowMap>& shadows;
  Runs& runs;  ///< memory for those of a tile
  const LightTable& table = light_table();
};

/// A tile's pixels, R in the lowest byte, the highest one unused; or a number of each.
struct alignas(64) TilePixels : std::array<std::uint32_t, kTilePixels> {};

/// A tile's light, 0..LightTable::kWhite.
struct TileLight {
  alignas(64) std::array<float, kTilePixels> r, g, b;
};

/// The layers of an exposure that a tile is drawn with: every `step`th.
struct Exposed {
  std::span<const Layer> all_layers;
  std::span<const TileIds> all_ids;
  std::size_t list;  ///< the place of the tile's triangles in each layer
  std::size_t first, step, count;
  double motion_px;                       ///< during the exposure, at most
  std::span<const Primitive> primitives;  ///< by their keys, less 1

  std::size_t place(std::size_t k) const { return first + step * k; }
  const Layer& layer(std::size_t k) const { return all_layers[place(k)]; }
  const TileIds& ids(std::size_t k) const { return all_ids[place(k)]; }
};

/// The picture of one layer, without transparent things.
void shade(const Shading& shading, const Layer& layer, const Tile& tile, const TileIds& ids,
           TilePixels& pixels);

/// The picture of the mean light of several layers, without transparent things, whose triangles are
/// named by keys. A triangle that a pixel sees in several layers is shaded once, and its texture is
/// averaged along the way that it moves.
void shade_mean(const Shading& shading, const Exposed& exposed, const Tile& tile,
                TilePixels& pixels);

/// Mixes the transparent triangles of `ids` into `pixels` by their opacity.
void shade_over(const Shading& shading, const Layer& layer, const Tile& tile, const TileIds& ids,
                TilePixels& pixels);
/// Adds the light of pixels, of one out of `layers` layers.
void add_light(const LightTable& table, const TilePixels& pixels, int layers, TileLight& light);
/// The pixels of light.
void encode_light(const LightTable& table, const TileLight& light, TilePixels& pixels);

/// Three bytes for each of a row's pixels.
void store_row(const std::uint32_t* pixels, int count, std::uint8_t* rgb);

/// The entities that a tile's pixels show. `by_key`: the triangles, if `ids` are keys; else empty.
void find_entities(const Layer& layer, std::span<const Primitive> by_key, const Tile& tile,
                   const TileIds& ids, TilePixels& entities);

/// The first of `values` after `begin` that differs from that one.
std::size_t end_of_run(std::span<const std::uint32_t> values, std::size_t begin);

}  // namespace tether::raster
