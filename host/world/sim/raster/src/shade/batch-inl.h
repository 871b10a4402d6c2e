#if defined(TETHER_RASTER_BATCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TETHER_RASTER_BATCH_INL_H_
#undef TETHER_RASTER_BATCH_INL_H_
#else
#define TETHER_RASTER_BATCH_INL_H_
#endif

#include "shade/light-inl.h"
#include "shade/runs.h"
#include "shade/shade.h"
#include "shade/surface-inl.h"
#include "shade/texture-inl.h"
#include "vector-inl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

// The pixels of a tile that see one triangle, shaded together: all its numbers are constants.
HWY_BEFORE_NAMESPACE();
namespace tether::raster::HWY_NAMESPACE {
namespace {

// Calls `use` with the first pixel of each run of bits in a row of a tile, and that after its last
// one. A bit of `ends` is the last one of its run, and so is the last one that is followed by a 0.
template <class Use>
HWY_INLINE void for_each_run_of(std::uint32_t bits, std::uint32_t ends, std::size_t row_begin,
                                const Use& use) {
  while (bits != 0) {
    const int begin = std::countr_zero(bits);
    const int end = std::countr_zero((ends | ~(bits >> 1U)) & (~0U << begin)) + 1;
    use(row_begin + static_cast<std::size_t>(begin), row_begin + static_cast<std::size_t>(end));
    bits &= static_cast<std::uint32_t>(~std::uint64_t{0} << end);
  }
}

// Calls `make` with the place of each vector in a row of a tile; returns the bits of its masks.
template <class Make>
HWY_INLINE std::uint32_t bits_of_row(std::size_t row_begin, const Make& make) {
  static_assert(kTile_px == 32);
  std::uint32_t all = 0;
  for (std::size_t i = 0; i < kTile_px; i += lanes()) {
    std::uint32_t bits = 0;
    hn::StoreMaskBits(DU(), make(row_begin + i), reinterpret_cast<std::uint8_t*>(&bits));
    all |= bits << i;
  }
  return all;
}

// Which pixels of a row have another id after them.
HWY_INLINE std::uint32_t ends_of_row(const TileIds& ids, std::size_t row_begin) {
  return bits_of_row(row_begin, [&](std::size_t at) HWY_ATTR {
    const std::uint32_t* const first = ids.id.data() + at;
    return hn::Ne(hn::Load(DU(), first), hn::LoadU(DU(), first + 1));
  });
}

// Calls `use` with each run of a tile's pixels that have the same id, and that id.
template <class Use>
HWY_INLINE void for_each_run(const Tile& tile, const TileIds& ids, const Use& use) {
  const std::uint32_t all = ~0U >> (kTile_px - tile.width);
  const std::size_t pixels = static_cast<std::size_t>(tile.height) * kTile_px;
  if (ids.everywhere != 0) return use(ids.everywhere, 0, pixels);
  for (std::size_t row = 0; row < pixels; row += kTile_px) {
    for_each_run_of(all, ends_of_row(ids, row), row,
                    [&](std::size_t begin, std::size_t end) { use(ids.id[begin], begin, end); });
  }
}

// The same for those whose id is not that of `others`. All or none have the same id everywhere.
template <class Use>
HWY_INLINE void for_each_difference(const Tile& tile, const TileIds& ids, const TileIds& others,
                                    const Use& use) {
  if (ids.everywhere != 0) return;
  const std::uint32_t all = ~0U >> (kTile_px - tile.width);
  const auto rows = static_cast<std::size_t>(tile.height);
  for (std::size_t begin = 0; begin < rows * kTile_px; begin += kTile_px) {
    const std::uint32_t differing = bits_of_row(begin, [&](std::size_t at) HWY_ATTR {
      return hn::Ne(hn::Load(DU(), ids.id.data() + at), hn::Load(DU(), others.id.data() + at));
    });
    if ((differing & all) == 0) continue;
    for_each_run_of(differing & all, ends_of_row(ids, begin), begin,
                    [&](std::size_t first, std::size_t end) { use(ids.id[first], first, end); });
  }
}

// Pixels of a tile: vectors of neighbours, and single ones, which fill the vectors after those.
class Batch {
 public:
  void clear() { neighbours_ = singles_ = 0; }
  // Some that follow each other.
  HWY_INLINE void add(std::size_t begin, std::size_t end) {
    for (; end - begin >= lanes(); begin += lanes()) {
      of_neighbours_[neighbours_++] = static_cast<std::uint16_t>(begin);
    }
    store_singles(hn::Iota(DI(), static_cast<std::int32_t>(begin)));
    singles_ += end - begin;
  }
  void add(std::size_t pixel) { of_singles_[singles_++] = static_cast<std::int32_t>(pixel); }
  // Fills the last vector up with its last pixel.
  HWY_INLINE void fill_up() {
    if (singles_ > 0) store_singles(whole(of_singles_[singles_ - 1]));
  }

  std::span<const std::int32_t> singles() const { return {of_singles_.data(), singles_}; }
  std::size_t vectors() const { return neighbours_ + (singles_ + lanes() - 1) / lanes(); }
  Place place(std::size_t vector) const {
    if (vector < neighbours_) return {of_neighbours_[vector], nullptr};
    return {0, of_singles_.data() + (vector - neighbours_) * lanes()};
  }

 private:
  HWY_INLINE void store_singles(VI places) {
    hn::StoreU(places, DI(), of_singles_.data() + singles_);
  }

  std::size_t neighbours_ = 0;
  std::size_t singles_ = 0;
  std::array<std::uint16_t, kTilePixels> of_neighbours_;
  alignas(64) std::array<std::int32_t, kTilePixels + kMaxLanes> of_singles_;
};

// Out of line, for the registers' sake.
HWY_NOINLINE inline Colour light_fully(const LayerTile& on, const Surface& s,
                                       const MaterialRow& material) {
  return light_up(on.shading, on.layer, s, material);
}

// Up to this many vectors are lit before they get their textures: they stay in the cache.
inline constexpr std::size_t kCells = 16;
using Cells = std::array<Cell, kCells>;

// Puts some vectors of a triangle under its lights.
template <bool kIsTextured, bool kIsFlat>
HWY_INLINE void light_cells(const LayerTile& on, const Facet& facet, const Batch& batch,
                            std::size_t first, std::size_t count, Cells& cells) {
  const Sight sight(on);
  const Facet f = facet;  // copies: nothing that is stored can change them
  const MaterialRow material = on.shading.scene.materials[f.material];
  const Colour base = colour(material.base);
  const Colour diffuse = colour(material.diffuse);
  const bool is_plain = on.layer.only_points && !(material.is_shiny != 0 && on.layer.any_specular);
  for (std::size_t i = 0; i < count; ++i) {
    Cell& c = cells[i];
    const Place at = batch.place(first + i);
    const Pixels p = sight.pixels(at);
    const Spot on_facet = spot(f.depth, p);
    const V z = on_facet.z;
    const Normal n = kIsFlat ? Normal{set(f.normal[0][0]), set(f.normal[1][0]), set(f.normal[2][0])}
                             : normal_at(f, on_facet);
    const Surface s{Mul(p.ray_x, z), Mul(p.ray_y, z), z, n, base, diffuse};
    store(is_plain ? light_up(on.shading, on.layer, s, nullptr) : light_fully(on, s, material), c);
    if (!kIsTextured) continue;
    const TexturePoint point = texture_point(f, on_facet);
    store(point.u, c.u);
    store(point.v, c.v);
    store(point.texels_per_pixel2, c.texels_per_pixel2);
    store(level_of(material, point), c.level);
  }
}

// Shades the pixels of a triangle. `finish` gets the place of each vector and its cell.
template <class Finish>
HWY_INLINE void shade_batch(const LayerTile& on, const Facet& facet, const Batch& batch,
                            const Finish& finish) {
  Cells cells;
  using LightCells =
      void (*)(const LayerTile&, const Facet&, const Batch&, std::size_t, std::size_t, Cells&);
  static constexpr std::array<LightCells, 4> kLightCells{
      light_cells<false, false>, light_cells<false, true>, light_cells<true, false>,
      light_cells<true, true>};
  const bool is_textured = on.shading.scene.materials[facet.material].first_level > 0;
  const auto light_some = kLightCells[(is_textured ? 2U : 0U) + (facet.is_flat ? 1U : 0U)];
  for (std::size_t first = 0; first < batch.vectors(); first += kCells) {
    const std::size_t count = std::min(kCells, batch.vectors() - first);
    light_some(on, facet, batch, first, count, cells);
    for (std::size_t i = 0; i < count; ++i) finish(batch.place(first + i), cells[i]);
  }
}

// The pixels of a cell, at a place of its material's texture.
HWY_INLINE VU pixels_at(const PreparedScene& scene, const MaterialRow& material, const Cell& c, V u,
                        V v) {
  return pixels(colour(c), set(material.alpha),
                material.first_level > 0 ? sample(scene, load(c.level), u, v) : white());
}
HWY_INLINE VU pixels_of(const PreparedScene& scene, const MaterialRow& material, const Cell& c) {
  return pixels_at(scene, material, c, load(c.u), load(c.v));
}

// Shades what a tile shows. `use_empty` gets the place of each vector without a triangle, and
// `of_triangle` returns what gets the place of each vector with a triangle and its cell.
template <class UseEmpty, class OfTriangle>
HWY_INLINE void shade_tile(const LayerTile& on, const TileIds& ids, const UseEmpty& use_empty,
                           const OfTriangle& of_triangle) {
  Runs& runs = on.shading.runs;
  runs.clear(on.layer.coverage.size() + 1);
  for_each_run(on.tile, ids, [&](std::uint32_t id, std::size_t begin, std::size_t end) {
    runs.add(id, begin, end);
  });
  for (const std::uint32_t id : runs.ids()) {
    Batch batch;
    runs.for_each(id, [&](std::size_t begin, std::size_t end, std::size_t)
                          HWY_ATTR { batch.add(begin, end); });
    batch.fill_up();
    if (id == 0) {
      for (std::size_t i = 0; i < batch.vectors(); ++i) use_empty(batch.place(i));
    } else {
      const Facet& facet = on.layer.facet(on.shading.scene, id - 1);
      shade_batch(on, facet, batch, of_triangle(facet));
    }
  }
}

HWY_INLINE VU background_of(const PreparedScene& scene) {
  return packed(colour(scene.background), set(1.0F));
}

}  // namespace
}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
