#include "strip_renderer.h"

#include "place/lights.h"

#include <algorithm>
#include <array>
#include <limits>

namespace tether::raster {
namespace {

struct Offset {
  double x_px, y_px;
};

// Four samples of which no two share a row or a column.
constexpr std::array<Offset, 4> kOffsets{
    {{-0.125, -0.375}, {0.375, -0.125}, {-0.375, 0.125}, {0.125, 0.375}}};

// Of 32 surfaces of which a tenth is opaque, what is behind has 3 % left.
constexpr std::size_t kMostTransparent = 32;

// Calls `use` with each tile of a strip and the place of its lists.
template <class Use>
void for_each_tile(const Lens& lens, const Strip& strip, Use use) {
  std::size_t list = 0;
  for (int y = 0; y < strip.rows; y += kTile_px) {
    for (int x = 0; x < lens.camera().width_px; x += kTile_px, ++list) {
      use(Tile{x, strip.first_row + y, std::min(kTile_px, lens.camera().width_px - x),
               std::min(kTile_px, strip.rows - y)},
          list);
    }
  }
}

std::size_t place_of(int column, int row) {
  return static_cast<std::size_t>(row) * kTile_px + static_cast<std::size_t>(column);
}

// The place in a whole picture of a tile's pixel.
std::size_t place_in_picture(const Lens& lens, const Tile& tile, int row) {
  return static_cast<std::size_t>(tile.y + row) * static_cast<std::size_t>(lens.camera().width_px) +
         static_cast<std::size_t>(tile.x);
}

bool is_blind(const Lens& lens, const Tile& tile, int column, int row) {
  if (lens.is_grid()) return false;
  return lens.x()[static_cast<std::size_t>(tile.y + row) * lens.stride() +
                  static_cast<std::size_t>(tile.x + column)] == Lens::kBlind;
}

}  // namespace

void place_layer(const PreparedScene& scene, const Lens& lens,
                 const std::vector<ShadowMap>& shadows, const View& view, const Strip& strip,
                 const PixelRect& pixels, double before_end_s, Moment& moment, Layer& layer) {
  interpolate(view, before_end_s, moment);
  layer.X_CW = inverse(moment.X_WC);
  layer.X_WB.swap(moment.X_WB);
  layer.projection = {view.camera.fx_px, view.camera.fy_px, view.camera.cx_px + layer.offset_x_px,
                      view.camera.cy_px + layer.offset_y_px, view.near_m};
  Selection selection;
  selection.pixels = pixels;
  selection.hidden = view.hidden;
  place_triangles(scene, lens, strip, selection, layer);
  place_lights(scene, shadows, layer);
}

void StripRenderer::draw(const Job& job, const Strip& strip) {
  place(job, strip);
  for_each_tile(job.lens, strip,
                [&](const Tile& tile, std::size_t list) { draw_tile(job, tile, list); });
}

void StripRenderer::place(const Job& job, const Strip& strip) {
  placed_ = 1;
  if (job.view.antialias) {
    const auto most = static_cast<std::size_t>(job.sampling.most_layers());
    placed_ = most > 1 ? std::max<std::size_t>(most, 9) : kOffsets.size();
  } else {
    for_each_tile(job.lens, strip, [&](const Tile& tile, std::size_t) {
      placed_ = std::max(placed_, layers_of(job, tile));
    });
  }
  if (layers_.size() < placed_) layers_.resize(placed_);
  if (ids_.size() < placed_) ids_.resize(placed_);
  const bool is_rolling = job.sampling.band_rows() > 0;
  const double row =
      is_rolling ? strip.first_row + 0.5 * (strip.rows - 1) : 0.5 * (job.view.camera.height_px - 1);
  for (std::size_t i = 0; i < placed_; ++i) {
    Layer& layer = layers_[i];
    const Offset offset = job.view.antialias ? kOffsets[i % kOffsets.size()] : Offset{0.0, 0.0};
    layer.offset_x_px = offset.x_px;
    layer.offset_y_px = offset.y_px;
    if (job.middle != nullptr && i == placed_ / 2) {
      std::swap(layer, *job.middle);
    } else {
      place_layer(job.scene, job.lens, job.shadows, job.view, strip, pixels_with(i, job, strip),
                  before_end_s(job.view, row, static_cast<int>(i), static_cast<int>(placed_)),
                  moment_, layer);
    }
  }
  if (placed_ > 1) set_keys(std::span(layers_).first(placed_), primitives_);
}

std::size_t StripRenderer::layers_of(const Job& job, const Tile& tile) const {
  return job.view.antialias ? placed_ : static_cast<std::size_t>(job.sampling.layers(tile));
}

// The tiles that have a layer.
PixelRect StripRenderer::pixels_with(std::size_t layer, const Job& job, const Strip& strip) const {
  PixelRect pixels = PixelRect::none();
  for_each_tile(job.lens, strip, [&](const Tile& tile, std::size_t) {
    const std::size_t step = placed_ / layers_of(job, tile);
    if (layer % step != step / 2) return;
    pixels.include(pixels_of(tile));
  });
  return pixels;
}

Exposed StripRenderer::exposed_on(const Job& job, const Tile& tile, std::size_t list) const {
  const std::size_t count = layers_of(job, tile);
  const std::size_t step = placed_ / count;
  return {std::span(layers_).first(placed_), ids_,       list, step / 2, step, count,
          job.sampling.exposed_px(tile),     primitives_};
}

void StripRenderer::draw_tile(const Job& job, const Tile& tile, std::size_t list) {
  const Exposed exposed = exposed_on(job, tile, list);
  rasterize(job, exposed, tile);
  if (!job.picture.rgb.empty()) {
    shade(job, exposed, tile);
    if (job.lens.blind_pixels() > 0) darken_blind(job.lens, tile);
    store_rgb(job, tile);
  }
  if (!job.picture.depth_m.empty()) store_depth(job, tile);
  if (!job.picture.entity.empty()) store_entities(job, exposed, tile);
}

// Sets TileIds::everywhere if all layers of a tile show the same triangle in all pixels. Depths
// need more than that.
bool StripRenderer::find_only(const Job& job, const Exposed& exposed, const Tile& tile,
                              Names names) {
  if (tile.width < kTile_px || !job.picture.depth_m.empty() || job.lens.blind_pixels() > 0) {
    return false;
  }
  std::uint32_t id = 0;
  for (std::size_t k = 0; k < exposed.count; ++k) {
    const Layer& layer = exposed.layer(k);
    if (!layer.transparent[exposed.list].empty()) return false;
    const auto only =
        raster::find_only(layer, job.lens, tile, layer.opaque[exposed.list], job.view.far_m);
    if (!only) return false;
    const std::uint32_t own = name_of(layer, *only, names);
    if (k > 0 && own != id) return false;
    id = own;
  }
  for (std::size_t k = 0; k < exposed.count; ++k) ids_[exposed.place(k)].everywhere = id;
  return true;
}

void StripRenderer::rasterize(const Job& job, const Exposed& exposed, const Tile& tile) {
  const Names names = shades_mean(exposed) ? Names::kKeys : Names::kPlaces;
  if (find_only(job, exposed, tile, names)) return;
  for (std::size_t k = 0; k < exposed.count; ++k) {
    const std::size_t i = exposed.place(k);
    clear(job.view.far_m, ids_[i]);
    rasterize_nearest(layers_[i], job.lens, tile, layers_[i].opaque[exposed.list], names, ids_[i]);
  }
}

// Whether a tile is shaded for several layers at once: nothing in it is transparent.
bool StripRenderer::shades_mean(const Exposed& exposed) {
  if (exposed.count == 1) return false;
  for (std::size_t k = 0; k < exposed.count; ++k) {
    if (!exposed.layer(k).transparent[exposed.list].empty()) return false;
  }
  return true;
}

void StripRenderer::shade(const Job& job, const Exposed& exposed, const Tile& tile) {
  const Shading shading{job.scene, job.lens, job.shadows, runs_};
  if (shades_mean(exposed)) {
    shade_mean(shading, exposed, tile, pixels_);
    return;
  }
  const auto layers = static_cast<int>(exposed.count);
  if (layers > 1) light_ = {};
  for (std::size_t k = 0; k < exposed.count; ++k) {
    raster::shade(shading, exposed.layer(k), tile, exposed.ids(k), pixels_);
    add_transparent(shading, exposed.layer(k), tile, exposed.list, exposed.ids(k));
    if (layers > 1) add_light(shading.table, pixels_, layers, light_);
  }
  if (layers > 1) encode_light(shading.table, light_, pixels_);
}

// The nearest ones are found first, and mixed in last. Those behind kMostTransparent are left out.
void StripRenderer::add_transparent(const Shading& shading, const Layer& layer, const Tile& tile,
                                    std::size_t list, const TileIds& opaque) {
  if (layer.transparent[list].empty()) return;
  transparent_.resize(kMostTransparent + 1);
  clear(0.0, transparent_[0]);  // before everything
  std::size_t count = 0;
  while (count < kMostTransparent &&
         rasterize_next(layer, shading.lens, tile, layer.transparent[list], opaque,
                        transparent_[count], transparent_[count + 1])) {
    ++count;
  }
  for (; count > 0; --count) shade_over(shading, layer, tile, transparent_[count], pixels_);
}

void StripRenderer::darken_blind(const Lens& lens, const Tile& tile) {
  for (int row = 0; row < tile.height; ++row) {
    for (int column = 0; column < tile.width; ++column) {
      if (is_blind(lens, tile, column, row)) pixels_[place_of(column, row)] = 0;
    }
  }
}

void StripRenderer::store_rgb(const Job& job, const Tile& tile) const {
  for (int row = 0; row < tile.height; ++row) {
    store_row(pixels_.data() + place_of(0, row), tile.width,
              job.picture.rgb.data() + 3 * place_in_picture(job.lens, tile, row));
  }
}

void StripRenderer::store_depth(const Job& job, const Tile& tile) const {
  const TileIds& ids = ids_[placed_ / 2];
  const auto depth_of = [&](std::size_t i) {
    if (ids.id[i] == 0) return std::numeric_limits<float>::infinity();
    const float z = 1.0F / ids.inverse_depth[i];
    if (z > job.picture.depth_max_m) return std::numeric_limits<float>::infinity();
    return z < job.picture.depth_min_m ? -std::numeric_limits<float>::infinity() : z;
  };
  for (int row = 0; row < tile.height; ++row) {
    float* const out = job.picture.depth_m.data() + place_in_picture(job.lens, tile, row);
    for (int column = 0; column < tile.width; ++column) {
      out[column] = is_blind(job.lens, tile, column, row) ? std::numeric_limits<float>::quiet_NaN()
                                                          : depth_of(place_of(column, row));
    }
  }
}

void StripRenderer::store_entities(const Job& job, const Exposed& exposed, const Tile& tile) {
  const std::size_t middle = exposed.count / 2;
  std::span<const Primitive> by_key;
  if (shades_mean(exposed)) by_key = exposed.primitives;
  find_entities(exposed.layer(middle), by_key, tile, exposed.ids(middle), pixels_);

  for (int row = 0; row < tile.height; ++row) {
    std::copy_n(pixels_.data() + place_of(0, row), tile.width,
                job.picture.entity.data() + place_in_picture(job.lens, tile, row));
  }
}

}  // namespace tether::raster
