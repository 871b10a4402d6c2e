#if defined(TETHER_RASTER_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TETHER_RASTER_BLOCK_INL_H_
#undef TETHER_RASTER_BLOCK_INL_H_
#else
#define TETHER_RASTER_BLOCK_INL_H_
#endif

#include "light-inl.h"
#include "shade.h"
#include "surface-inl.h"
#include "texture-inl.h"
#include "vector-inl.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

// The colours of some rows of a tile, step by step.
HWY_BEFORE_NAMESPACE();
namespace tether::raster::HWY_NAMESPACE {
namespace {

// A layer's part of a tile, from one of its rows on.
struct Part {
  const Shading& shading;
  const Layer& layer;
  const Tile& tile;
  int first_row, rows;

  std::size_t first_pixel() const { return static_cast<std::size_t>(first_row) * kTile_px; }
};

// Calls `use` with each block of a tile.
template <class Use>
HWY_INLINE void for_each_part(const Shading& shading, const Layer& layer, const Tile& tile,
                              const Use& use) {
  for (int row = 0; row < tile.height; row += Block::kRows) {
    use(Part{shading, layer, tile, row, std::min(Block::kRows, tile.height - row)});
  }
}

// Calls `use` with the place in its block of each vector of pixels.
template <class Use>
HWY_INLINE void for_each_vector(const Part& part, const Use& use) {
  for (int row = 0; row < part.rows; ++row) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(part.tile.width); c += lanes()) {
      use(static_cast<std::size_t>(row) * kTile_px + c);
    }
  }
}

// Puts what some pixels see of a triangle into a block; the first into all of the vector.
template <bool kIsFirst>
HWY_INLINE void put_surface(const Part& part, const Facet& f, const Pixels& p, std::size_t at,
                            hn::Mask<DI> same, Block& b) {
  const PreparedScene& scene = part.shading.scene;
  const MaterialRow& material = scene.materials[f.material];
  const M mask = float_mask(same);
  const auto put = [&](Block::Plane<float>& plane, V value) HWY_ATTR {
    store(kIsFirst ? value : hn::IfThenElse(mask, value, load(plane, at)), plane, at);
  };
  const auto put_whole = [&](Block::Plane<std::int32_t>& plane, VI value) HWY_ATTR {
    hn::Store(kIsFirst ? value : hn::IfThenElse(same, value, load(plane, at)), DI(),
              plane.data() + at);
  };
  const Spot s = spot(f, p);
  put(b.x, Mul(p.ray_x, s.z));
  put(b.y, Mul(p.ray_y, s.z));
  put(b.z, s.z);
  const bool is_textured = material.first_level > 0;
  Weights w{};
  if (is_textured || f.is_flat == 0) w = weights(f, s);
  const Normal n = f.is_flat != 0
                       ? Normal{set(f.normal[0][0]), set(f.normal[1][0]), set(f.normal[2][0])}
                       : normal(f, w);
  put(b.nx, n.x);
  put(b.ny, n.y);
  put(b.nz, n.z);
  put(b.r, set(material.base[0]));
  put(b.g, set(material.base[1]));
  put(b.b, set(material.base[2]));
  put_whole(b.material, whole(static_cast<std::int32_t>(f.material)));
  Block::Vector& vector = b.vectors[b.vector_count - 1];
  vector.is_shiny = vector.is_shiny || material.is_shiny != 0;
  vector.is_textured = vector.is_textured || is_textured;
  if (!is_textured) {
    put_whole(b.level, whole(0));
    put_whole(b.next_share, whole(0));
    put(b.u, set(0.0F));
    put(b.v, set(0.0F));
    put(b.texels_per_pixel2, set(1.0F));
    return;
  }
  const TexturePoint point = texture_point(f, s, w);
  const Filter filter = make_filter(scene, material, point);
  put(b.u, point.u);
  put(b.v, point.v);
  put(b.texels_per_pixel2, filter.texels_per_pixel2);
  put_whole(b.level, filter.level);
  put_whole(b.next_share, filter.next_share);
}

// The colours of the triangles of `b.ids`, under all lights, before their textures.
void light_block(const Part& part, Block& b) {
  b.vector_count = 0;
  for_each_vector(part, [&](std::size_t at) HWY_ATTR {
    const VU ids = hn::Load(DU(), b.ids.data() + at);
    if (hn::AllTrue(DU(), hn::Eq(ids, hn::Zero(DU())))) return;
    b.vectors[b.vector_count++] = {static_cast<std::uint16_t>(at), false, false};
    store(set(0.0F), b.diffuse, at);
    store(set(0.0F), b.specular, at);
    const Pixels p = pixels_at(part.shading.lens, part.layer, part.tile, part.first_pixel() + at);
    for_each_facet(ids, [&](std::size_t index, hn::Mask<DI> same, auto is_first) HWY_ATTR {
      put_surface<is_first.value>(part, part.layer.facets[index], p, at, same, b);
    });
  });
  light_up(part.shading, part.layer, b);
}

HWY_INLINE Colour colour_at(const Block& b, std::size_t at) {
  return {load(b.r, at), load(b.g, at), load(b.b, at)};
}

// At most 1.
HWY_INLINE Colour lit_at(const Block& b, std::size_t at) {
  const Colour c = colour_at(b, at);
  const V one = set(1.0F);
  return {hn::Min(c.r, one), hn::Min(c.g, one), hn::Min(c.b, one)};
}

HWY_INLINE void set_colour(const Colour& c, Block& b, std::size_t at) {
  store(c.r, b.r, at);
  store(c.g, b.g, at);
  store(c.b, b.b, at);
}

// The same with textures and, if wanted, opacity.
void shade_block(const Part& part, bool with_alpha, Block& b) {
  const PreparedScene& scene = part.shading.scene;
  light_block(part, b);
  for (const Block::Vector& vector : b.active()) {
    const std::size_t at = vector.at;
    const V one = set(1.0F);
    Texel texel{{one, one, one}, one};
    if (vector.is_textured) {
      texel =
          sample(scene, load(b.level, at), load(b.next_share, at), load(b.u, at), load(b.v, at));
    }
    set_colour(scaled(lit_at(b, at), texel.colour), b, at);
    if (!with_alpha) continue;
    const V alpha = of_material(load(b.material, at), scene.materials[0].alpha);
    store(Mul(alpha, texel.alpha), b.alpha, at);
  }
}

HWY_INLINE void load_ids(const Part& part, const TileIds& ids, Block& b) {
  const auto* const first = ids.id.data() + part.first_pixel();
  std::copy_n(first, static_cast<std::size_t>(part.rows) * kTile_px, b.ids.data());
}

HWY_INLINE M is_empty(const Block& b, std::size_t at) {
  return hn::RebindMask(D(), hn::Eq(hn::Load(DU(), b.ids.data() + at), hn::Zero(DU())));
}

}  // namespace
}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
