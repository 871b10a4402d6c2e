#pragma once

#include "exposure.h"
#include "place/layer.h"
#include "place/lens.h"
#include "place/rasterize.h"
#include "place/shadow_map.h"
#include "shade/shade.h"

#include <vector>

#include <tether/sim_raster/renderer.h>

namespace tether::raster {

/// Places what some pixels of a strip show at a time of the view.
void place_layer(const PreparedScene& scene, const Lens& lens,
                 const std::vector<ShadowMap>& shadows, const View& view, const Strip& strip,
                 const PixelRect& pixels, double before_end_s, Moment& moment, Layer& layer);

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
    const Sampling& sampling;
    /// The whole picture in the middle of the view's time, if a strip may take it; else null.
    Layer* middle;
  };

  void draw(const Job& job, const Strip& strip);

 private:
  void place(const Job& job, const Strip& strip);
  std::size_t layers_of(const Job& job, const Tile& tile) const;
  PixelRect pixels_with(std::size_t layer, const Job& job, const Strip& strip) const;
  Exposed exposed_on(const Job& job, const Tile& tile, std::size_t list) const;
  void draw_tile(const Job& job, const Tile& tile, std::size_t list);
  bool find_only(const Job& job, const Exposed& exposed, const Tile& tile, Names names);
  void rasterize(const Job& job, const Exposed& exposed, const Tile& tile);
  static bool shades_mean(const Exposed& exposed);
  void shade(const Job& job, const Exposed& exposed, const Tile& tile);
  void add_transparent(const Shading& shading, const Layer& layer, const Tile& tile,
                       std::size_t list, const TileIds& opaque);
  void darken_blind(const Lens& lens, const Tile& tile);
  void store_rgb(const Job& job, const Tile& tile) const;
  void store_depth(const Job& job, const Tile& tile) const;
  void store_entities(const Job& job, const Exposed& exposed, const Tile& tile);

  std::size_t placed_ = 0;             ///< layers of the tile that has most
  std::vector<Layer> layers_;          ///< so many, or more
  std::vector<TileIds> ids_;           ///< of each layer, in the tile
  std::vector<Primitive> primitives_;  ///< of all layers, if there are several
  Runs runs_;
  std::vector<TileIds> transparent_;  ///< the nearest triangles, the next ones, and so on
  TileLight light_{};
  TilePixels pixels_{};
  Moment moment_;
};

}  // namespace tether::raster
