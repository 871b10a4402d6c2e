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

// Calls `use` with each block of a tile.
template <class Use>
HWY_INLINE void for_each_part(const Shading& shading, const Layer& layer, const Tile& tile,
                              const TileIds& ids, const Use& use) {
  for (int row = 0; row < tile.height; row += Block::kRows) {
    use(Part{shading, layer, tile, ids, row, std::min(Block::kRows, tile.height - row)});
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

HWY_INLINE V depth_at(const Part& part, std::size_t at) {
  const float* const inverse = part.ids.inverse_depth.data() + part.first_pixel() + at;
  return Div(set(1.0F), hn::Load(D(), inverse));
}

// Numbers of the materials that the light needs.
struct Shine {
  const PreparedScene& scene;
  const Block::Run& run;
  const Cell& cell;
  bool is_shiny;

  V exponent() const { return of_material(run, cell, scene.materials[0].shininess); }
  Colour specular() const {
    const auto& first = scene.materials[0].specular;
    return {of_material(run, cell, first[0]), of_material(run, cell, first[1]),
            of_material(run, cell, first[2])};
  }
};

// Out of line, for the registers' sake.
HWY_NOINLINE void light_fully(const Part& part, const Surface& s, const Shine& shine, Cell& c) {
  store(light_up(part.shading, part.layer, s, shine), c);
}

HWY_INLINE void light(const Part& part, const Surface& s, const Block::Run& run, bool is_shiny,
                      Cell& c) {
  const Layer& layer = part.layer;
  if (layer.only_points && !(is_shiny && layer.any_specular)) {
    store(light_up(part.shading, layer, s, nullptr), c);
  } else {
    const Surface copy = s;  // whose address may be known
    light_fully(part, copy, {part.shading.scene, run, c, is_shiny}, c);
  }
}

// Puts a flat triangle into vectors that see nothing else.
template <bool kIsTextured>
HWY_INLINE void put_flat(const Part& part, const Sight& of_part, const Block::Run& run, Block& b) {
  const Sight sight = of_part;
  const Facet f = *run.flat;  // copies: nothing that is stored can change them
  const MaterialRow material = part.shading.scene.materials[f.material];
  const Normal n{set(f.normal[0][0]), set(f.normal[1][0]), set(f.normal[2][0])};
  const Colour base = colour(material.base);
  const Colour diffuse = colour(material.diffuse);
  for (const std::size_t at : b.places(run)) {
    Cell& c = b.cell(at);
    const Pixels p = sight.pixels(at);
    const V z = depth_at(part, at);
    light(part, {Mul(p.ray_x, z), Mul(p.ray_y, z), z, n, base, diffuse}, run,
          material.is_shiny != 0, c);
    if (!kIsTextured) continue;
    const TexturePoint point = texture_point(f, spot(f, p, z));
    store(point.u, c.u);
    store(point.v, c.v);
    store(point.texels_per_pixel2, c.texels_per_pixel2);
    store(level_of(material, point), c.level);
  }
}

// Puts what some pixels see of a triangle into a block; the first into all of the vector.
template <bool kIsFirst>
HWY_INLINE void put_surface(const MaterialRow& material, const Facet& f, const Spot& at,
                            hn::Mask<DI> same, Surface& s, Cell& c) {
  const M mask = float_mask(same);
  const auto put = [&](V& to, V value)
                       HWY_ATTR { to = kIsFirst ? value : hn::IfThenElse(mask, value, to); };
  const auto put_colour = [&](Colour& to, const std::array<float, 3>& value) HWY_ATTR {
    put(to.r, set(value[0]));
    put(to.g, set(value[1]));
    put(to.b, set(value[2]));
  };
  const auto store_at = [&](Lanes<float>& to, V value) HWY_ATTR {
    store(kIsFirst ? value : hn::IfThenElse(mask, value, load(to)), to);
  };
  const auto store_whole = [&](Lanes<std::int32_t>& to, VI value) HWY_ATTR {
    store(kIsFirst ? value : hn::IfThenElse(same, value, load(to)), to);
  };
  const Normal n = normal_at(f, at);
  put(s.normal.x, n.x);
  put(s.normal.y, n.y);
  put(s.normal.z, n.z);
  put_colour(s.base, material.base);
  put_colour(s.diffuse, material.diffuse);
  store_whole(c.material, whole(static_cast<std::int32_t>(f.material)));
  TexturePoint point{set(0.0F), set(0.0F), set(1.0F)};
  const bool is_textured = material.first_level > 0;
  if (is_textured) point = texture_point(f, at);
  store_at(c.u, point.u);
  store_at(c.v, point.v);
  store_at(c.texels_per_pixel2, point.texels_per_pixel2);
  store_whole(c.level, is_textured ? level_of(material, point) : whole(0));
}

// Puts several triangles, or a curved one, into vectors.
HWY_INLINE void put_mixed(const Part& part, const Sight& sight, Block::Run& run, Block& b) {
  for (const std::size_t at : b.places(run)) {
    Cell& c = b.cell(at);
    const Pixels p = sight.pixels(at);
    const V z = depth_at(part, at);
    const VU ids = hn::Load(DU(), b.ids.data() + at);
    Surface s;
    s.x = Mul(p.ray_x, z);
    s.y = Mul(p.ray_y, z);
    s.z = z;
    bool is_shiny = false;
    for_each_number(ids, [&](std::size_t index, hn::Mask<DI> same, auto is_first) HWY_ATTR {
      const Facet& f = part.layer.facets[index];
      const MaterialRow& material = part.shading.scene.materials[f.material];
      is_shiny = is_shiny || material.is_shiny != 0;
      run.is_textured = run.is_textured || material.first_level > 0;
      put_surface<is_first.value>(material, f, spot(f, p, z), same, s, c);
    });
    light(part, s, run, is_shiny, c);
  }
}

// Finds the vectors of a block that see triangles.
HWY_INLINE void find_runs(const Part& part, Block& b) {
  std::size_t runs = 0;
  std::uint16_t places = 0;
  VU of_run = hn::Zero(DU());  // the triangle of the last run, if it is flat
  for_each_vector(part, [&](std::size_t at) HWY_ATTR {
    const VU ids = hn::Load(DU(), b.ids.data() + at);
    const std::uint32_t one = hn::GetLane(ids);
    if (!hn::AllTrue(DU(), hn::Eq(ids, of_run)) || one == 0) {
      const bool is_one = hn::AllTrue(DU(), hn::Eq(ids, hn::Set(DU(), one)));
      if (is_one && one == 0) return;
      const Facet* flat = is_one ? &part.layer.facets[one - 1] : nullptr;
      if (flat != nullptr && flat->is_flat == 0) flat = nullptr;
      of_run = flat == nullptr ? hn::Zero(DU()) : ids;
      if (flat != nullptr || runs == 0 || b.all_runs[runs - 1].flat != nullptr) {
        b.all_runs[runs++] = {flat, places, places, false};
      }
    }
    b.all_places[places++] = static_cast<std::uint16_t>(at);
    b.all_runs[runs - 1].end = places;
  });
  b.run_count = runs;
}

// The colours of the triangles of `b.ids`, under all lights, before their textures.
inline void light_block(const Part& part, Block& b) {
  const Sight sight(part);
  find_runs(part, b);
  for (Block::Run& run : std::span(b.all_runs).first(b.run_count)) {
    if (run.flat == nullptr) {
      put_mixed(part, sight, run, b);
      continue;
    }
    run.is_textured = part.shading.scene.materials[run.flat->material].first_level > 0;
    if (run.is_textured) {
      put_flat<true>(part, sight, run, b);
    } else {
      put_flat<false>(part, sight, run, b);
    }
  }
}

// The same with textures. Calls `use` with the place in the block of each vector with triangles,
// and with their pixels, which have their opacities if these are wanted.
template <bool kWithAlpha = false, class Use>
HWY_INLINE void shade_block(const Part& part, Block& b, const Use& use) {
  const PreparedScene& scene = part.shading.scene;
  light_block(part, b);
  const V one = set(1.0F);
  for (const Block::Run& run : b.runs()) {
    for (const std::size_t at : b.places(run)) {
      const Cell& c = b.cell(at);
      const V alpha = kWithAlpha ? of_material(run, c, scene.materials[0].alpha) : one;
      use(at,
          pixels(colour(c), alpha,
                 run.is_textured ? sample(scene, load(c.level), load(c.u), load(c.v)) : white()));
    }
  }
}

HWY_INLINE void load_ids(const Part& part, Block& b) {
  const auto* const first = part.ids.id.data() + part.first_pixel();
  std::copy_n(first, static_cast<std::size_t>(part.rows) * kTile_px, b.ids.data());
}

HWY_INLINE VU background_of(const Part& part) {
  return packed(colour(part.shading.scene.background), set(1.0F));
}

HWY_INLINE M is_empty(const Block& b, std::size_t at) {
  return hn::RebindMask(D(), hn::Eq(hn::Load(DU(), b.ids.data() + at), hn::Zero(DU())));
}

}  // namespace
}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
