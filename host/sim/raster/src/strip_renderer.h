#pragma once

#include "exposure.h"
#include "layer.h"
#include "lens.h"
#include "rasterize.h"
#include "shade.h"
#include "shadow_map.h"

#include <vector>

#include <tether/sim_raster/renderer.h>

namespace tether::raster {

/// Draws strips of pictures, one after the other. Each thread has its own, with its memory.
class StripRenderer {
 public:
  /// The data that all strips of a picture share. It must outlive the strips.
  struct Job {
    const PreparedScene& scene;
    const Lens& lens;
    const std::vector<ShadowMap>& shadows;
    const View& view;
    const Picture& picture;
    Sampling sampling;
  };

  void draw(const Job& job, const Strip& strip);

  /// The depth of the nearest visible surface, or `far_m`.
  double nearest_m(const Job& job, const Strip& strip);

 private:
  void place(const Job& job, const Strip& strip);
  void place_layer(const Job& job, const Strip& strip, std::size_t index);
  void draw_tile(const Job& job, const Tile& tile, std::size_t list);
  void rasterize(const Job& job, const Tile& tile, std::size_t list);
  void shade_with_transparent(const Job& job, const Tile& tile, std::size_t list);
  void add_transparent(const Shading& shading, const Layer& layer, const Tile& tile,
                       std::size_t list, const TileIds& opaque);
  void darken_blind(const Lens& lens, const Tile& tile);
  void store_rgb(const Job& job, const Tile& tile) const;
  void store_depth(const Job& job, const Tile& tile) const;
  void store_entities(const Job& job, const Tile& tile);

  std::vector<Layer> layers_;
  std::vector<TileIds> ids_;  ///< of each layer, in the tile
  TileIds last_{};
  TileIds next_{};
  TileLight light_{};
  TilePixels pixels_{};
  Moment moment_;
};

}  // namespace tether::raster
