#include "strip_renderer.h"

#include "lights.h"

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

void StripRenderer::draw(const Job& job, const Strip& strip) {
  place(job, strip);
  for_each_tile(job.lens, strip,
                [&](const Tile& tile, std::size_t list) { draw_tile(job, tile, list); });
}

double StripRenderer::nearest_m(const Job& job, const Strip& strip) {
  place(job, strip);
  float nearest = 0.0F;
  for_each_tile(job.lens, strip, [&](const Tile& tile, std::size_t list) {
    rasterize(job, tile, list);
    rasterize_nearest(layers_[0], job.lens, tile, layers_[0].transparent[list], ids_[0]);
    for (int row = 0; row < tile.height; ++row) {
      const float* const first = ids_[0].inverse_depth.data() + place_of(0, row);
      nearest = std::max(nearest, *std::max_element(first, first + tile.width));
    }
  });
  return 1.0 / static_cast<double>(nearest);
}

void StripRenderer::place(const Job& job, const Strip& strip) {
  const auto layers = static_cast<std::size_t>(job.sampling.layers);
  if (layers_.size() != layers) layers_.resize(layers);
  if (ids_.size() != layers) ids_.resize(layers);
  for (std::size_t i = 0; i < layers; ++i) place_layer(job, strip, i);
}

void StripRenderer::place_layer(const Job& job, const Strip& strip, std::size_t index) {
  const View& view = job.view;
  const double middle_row = strip.first_row + 0.5 * (strip.rows - 1);
  const double row = job.sampling.bands > 1 ? middle_row : 0.5 * (view.camera.height_px - 1);
  interpolate(view, before_end_s(view, row, static_cast<int>(index), job.sampling.layers), moment_);
  Layer& layer = layers_[index];
  layer.X_CW = inverse(moment_.X_WC);
  layer.X_WB.swap(moment_.X_WB);
  const Offset offset = view.antialias ? kOffsets[index % kOffsets.size()] : Offset{0.0, 0.0};
  layer.offset_x_px = offset.x_px;
  layer.offset_y_px = offset.y_px;
  layer.projection = {view.camera.fx_px, view.camera.fy_px, view.camera.cx_px + offset.x_px,
                      view.camera.cy_px + offset.y_px, view.near_m};
  Selection selection;
  selection.hidden = view.hidden;
  place_triangles(job.scene, job.lens, strip, selection, layer);
  place_lights(job.scene, job.shadows, layer);
}

void StripRenderer::draw_tile(const Job& job, const Tile& tile, std::size_t list) {
  rasterize(job, tile, list);
  const Shading shading{job.scene, job.lens, job.shadows};
  const bool any_transparent = std::any_of(layers_.begin(), layers_.end(), [&](const Layer& layer) {
    return !layer.transparent[list].empty();
  });
  if (!job.picture.rgb.empty()) {
    if (any_transparent) {
      shade_with_transparent(job, tile, list);
    } else if (layers_.size() > 1) {
      shade_mean(shading, layers_, tile, ids_, pixels_);
    } else {
      shade(shading, layers_[0], tile, ids_[0], pixels_);
    }
    if (job.lens.blind_pixels() > 0) darken_blind(job.lens, tile);
    store_rgb(job, tile);
  }
  if (!job.picture.depth_m.empty()) store_depth(job, tile);
  if (!job.picture.entity.empty()) store_entities(job, tile);
}

void StripRenderer::rasterize(const Job& job, const Tile& tile, std::size_t list) {
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    clear(job.view.far_m, ids_[i]);
    rasterize_nearest(layers_[i], job.lens, tile, layers_[i].opaque[list], ids_[i]);
  }
}

void StripRenderer::shade_with_transparent(const Job& job, const Tile& tile, std::size_t list) {
  const Shading shading{job.scene, job.lens, job.shadows};
  const auto layers = static_cast<int>(layers_.size());
  if (layers > 1) light_ = {};
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    shade(shading, layers_[i], tile, ids_[i], pixels_);
    add_transparent(shading, layers_[i], tile, list, ids_[i]);
    if (layers > 1) add_light(shading.table, pixels_, layers, light_);
  }
  if (layers > 1) encode_light(shading.table, light_, pixels_);
}

// From the farthest to the nearest, for each pixel.
void StripRenderer::add_transparent(const Shading& shading, const Layer& layer, const Tile& tile,
                                    std::size_t list, const TileIds& opaque) {
  last_ = opaque;
  while (rasterize_next(layer, shading.lens, tile, layer.transparent[list], last_, next_)) {
    shade_over(shading, layer, tile, next_, pixels_);
    std::swap(last_, next_);
  }
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
  const TileIds& ids = ids_[ids_.size() / 2];
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

void StripRenderer::store_entities(const Job& job, const Tile& tile) {
  find_entities(layers_[layers_.size() / 2], ids_[ids_.size() / 2], pixels_);
  for (int row = 0; row < tile.height; ++row) {
    std::copy_n(pixels_.data() + place_of(0, row), tile.width,
                job.picture.entity.data() + place_in_picture(job.lens, tile, row));
  }
}

}  // namespace tether::raster
