#include "shade.h"

#include "light_table.h"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade.cpp"
#include <hwy/foreach_target.h>
//
#include "light-inl.h"
#include "surface-inl.h"
#include "texture-inl.h"
#include "vector-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tether::raster::HWY_NAMESPACE {
namespace {

HWY_INLINE VI to_byte(V share) {
  return nearest(Mul(share, set(255.0F)));
}
HWY_INLINE VU packed(VI r, VI g, VI b) {
  return hn::BitCast(DU(), hn::Or(r, hn::Or(hn::ShiftLeft<8>(g), hn::ShiftLeft<16>(b))));
}
HWY_INLINE VU packed(const Colour& c) {
  return packed(to_byte(c.r), to_byte(c.g), to_byte(c.b));
}

// The light of a colour, rounded as bytes are: an exposed picture of a still scene is the plain
// one.
HWY_INLINE V light_of(const LightTable& table, V share) {
  return hn::GatherIndex(D(), table.light.data(), to_byte(share));
}
HWY_INLINE Colour light_of(const LightTable& table, const Colour& c) {
  return {light_of(table, c.r), light_of(table, c.g), light_of(table, c.b)};
}
HWY_INLINE VI byte_of_light(const LightTable& table, V light) {
  const DI di;
  const VI amount = hn::Min(nearest(light), whole(LightTable::kWhite));
  const auto* const bytes = reinterpret_cast<const std::int32_t*>(table.byte.data());
  return And(hn::GatherOffset(di, bytes, amount), whole(0xFF));
}

// The colour of a triangle at some pixels, for a whole texture of ones.
HWY_INLINE Colour light_on(const Shading& shading, const Layer& layer, const Facet& facet,
                           const MaterialRow& material, const Pixels& p, const Spot& at, M wanted) {
  return lit_colour(shading, layer, material, surface(facet, at, p), wanted);
}

HWY_INLINE Colour times_texel(const Colour& light, const Texel& texel) {
  const V scale = set(1.0F / kTexelScale);
  return scaled({Mul(light.r, scale), Mul(light.g, scale), Mul(light.b, scale)}, texel.colour);
}

// The colours of the triangles of `ids`, where `wanted`; `result` elsewhere.
HWY_INLINE void shade_pixels(const Shading& shading, const Layer& layer, const Tile& tile,
                             std::size_t at, VU ids, M wanted, Colour& result, V& alpha) {
  const Pixels p = pixels_at(shading.lens, layer, tile, at);
  for_each_facet(ids, wanted, [&](std::size_t index, M same) HWY_ATTR {
    const Facet& facet = layer.facets[index];
    const MaterialRow& material = shading.scene.materials[facet.material];
    const Spot s = spot(facet, p.x, p.y);
    Colour own = light_on(shading, layer, facet, material, p, s, same);
    V opacity = set(material.alpha);
    if (material.levels > 0) {
      const TexturePoint point = texture_point(facet, s);
      const Filter filter = make_filter(shading.scene, material, point);
      const Texel texel = sample(shading.scene, filter, point.u, point.v);
      own = times_texel(own, texel);
      opacity = Mul(opacity, Mul(texel.alpha, set(1.0F / kTexelScale)));
    }
    result = select(same, own, result);
    alpha = hn::IfThenElse(same, opacity, alpha);
  });
}

HWY_INLINE M everywhere() {
  const V zero = set(0.0F);
  return hn::Eq(zero, zero);
}

// Calls `use` with the place of each vector of a tile's pixels.
template <class Use>
HWY_INLINE void for_each_vector(const Tile& tile, const Use& use) {
  for (int row = 0; row < tile.height; ++row) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(tile.width); c += lanes()) {
      use(static_cast<std::size_t>(row) * kTile_px + c);
    }
  }
}

// The triangles that several pixels see, by their numbers; 0: none.
HWY_INLINE VI primitives(const Layer& layer, VU ids) {
  const DI di;
  const VI id = hn::BitCast(di, ids);
  const std::int32_t one = hn::GetLane(id);
  if (hn::AllTrue(di, hn::Eq(id, whole(one)))) {
    if (one == 0) return whole(0);
    const Facet& facet = layer.facets[static_cast<std::size_t>(one) - 1];
    return whole(static_cast<std::int32_t>(facet.primitive));
  }
  const auto is_seen = hn::Gt(id, whole(0));
  constexpr std::int32_t kFloats = sizeof(Facet) / sizeof(float);
  const VI row = Mul(hn::Max(Sub(id, whole(1)), whole(0)), whole(kFloats));
  const auto* const first = reinterpret_cast<const std::int32_t*>(&layer.facets[0].primitive);
  return hn::IfThenElseZero(is_seen, hn::GatherIndex(di, first, row));
}

// The layers in which pixels see the same triangle as in the middle one.
struct Stay {
  VI first, last;
  VI count;
};

// The mean light of one vector of pixels over some layers.
class Mean {
 public:
  Mean(const Shading& shading, std::span<const Layer> layers, const Tile& tile,
       std::span<const TileIds> ids, std::size_t at)
      : shading_(shading),
        layers_(layers),
        tile_(tile),
        ids_(ids),
        at_(at),
        middle_(layers.size() / 2),
        share_(1.0F / static_cast<float>(layers.size())) {}

  Colour light() const {
    const VI number = whole(static_cast<std::int32_t>(middle_));
    const VI middle = primitives(layers_[middle_], ids_in(middle_));
    Stay stay{number, number, whole(1)};
    Colour sum{set(0.0F), set(0.0F), set(0.0F)};
    for (std::size_t k = 0; k < layers_.size(); ++k) {
      if (k != middle_) add_layer(k, middle, stay, sum);
    }
    add_to(sum, middle_light(stay), Mul(to_float(stay.count), set(share_)));
    return sum;
  }

 private:
  VU ids_in(std::size_t layer) const { return hn::Load(DU(), ids_[layer].id.data() + at_); }

  // Counts the pixels that see the same as in the middle layer, and shades the others.
  void add_layer(std::size_t k, VI middle, Stay& stay, Colour& sum) const {
    const DI di;
    const VU ids = ids_in(k);
    const auto same = hn::Eq(primitives(layers_[k], ids), middle);
    const VI number = whole(static_cast<std::int32_t>(k));
    stay.count = Sub(stay.count, hn::VecFromMask(di, same));
    stay.first = hn::IfThenElse(same, hn::Min(stay.first, number), stay.first);
    stay.last = hn::IfThenElse(same, hn::Max(stay.last, number), stay.last);
    if (hn::AllTrue(di, same)) return;
    const M differs = hn::Not(float_mask(same));
    Colour own = colour(shading_.scene.background);
    V alpha = set(1.0F);
    shade_pixels(shading_, layers_[k], tile_, at_, ids, differs, own, alpha);
    add_to(sum, light_of(shading_.table, own), hn::IfThenElseZero(differs, set(share_)));
  }

  Colour middle_light(const Stay& stay) const {
    Colour light = light_of(shading_.table, colour(shading_.scene.background));
    const Layer& layer = layers_[middle_];
    const Pixels p = pixels_at(shading_.lens, layer, tile_, at_);
    for_each_facet(ids_in(middle_), everywhere(), [&](std::size_t index, M same) HWY_ATTR {
      const Facet& facet = layer.facets[index];
      const MaterialRow& material = shading_.scene.materials[facet.material];
      const Spot at = spot(facet, p.x, p.y);
      const Colour lit = light_on(shading_, layer, facet, material, p, at, same);
      Colour own;
      if (material.levels > 0) {
        const TexturePoint point = texture_point(facet, at);
        own = moving_texture(lit, point, make_filter(shading_.scene, material, point), stay, same);
      } else {
        own = light_of(shading_.table, lit);
      }
      light = select(same, own, light);
    });
    return light;
  }

  // Texture coordinates in the layers `of`, which differ from pixel to pixel.
  void coordinates_in(VI of, M wanted, V& u, V& v) const {
    M rest = wanted;
    for (std::size_t k = 0; !hn::AllFalse(D(), rest) && k < layers_.size(); ++k) {
      const M here = And(rest, float_mask(hn::Eq(of, whole(static_cast<std::int32_t>(k)))));
      if (hn::AllFalse(D(), here)) continue;
      rest = hn::AndNot(here, rest);
      const Pixels p = pixels_at(shading_.lens, layers_[k], tile_, at_);
      for_each_facet(ids_in(k), here, [&](std::size_t index, M same) HWY_ATTR {
        const Facet& facet = layers_[k].facets[index];
        const Spot s = spot(facet, p.x, p.y);
        u = hn::IfThenElse(same, between_corners(facet.u, s), u);
        v = hn::IfThenElse(same, between_corners(facet.v, s), v);
      });
    }
  }

  // The way that the texture goes under a pixel during the exposure.
  struct Way {
    V u, v;    // its middle
    V du, dv;  // its length
    VI taps;   // how many places of it are looked at: about a texel apart
  };

  // The first and the last layer are half a step within the ends of the way.
  Way way_of(const TexturePoint& point, const Filter& filter, const Stay& stay, M wanted) const {
    Way way{point.u, point.v, set(0.0F), set(0.0F), whole(1)};
    const M moves = And(wanted, float_mask(hn::Lt(stay.first, stay.last)));
    if (hn::AllFalse(D(), moves)) return way;
    V u_first = way.u;
    V v_first = way.v;
    V u_last = way.u;
    V v_last = way.v;
    coordinates_in(stay.first, moves, u_first, v_first);
    coordinates_in(stay.last, moves, u_last, v_last);
    const V steps = to_float(hn::Max(Sub(stay.last, stay.first), whole(1)));
    const V longer = Div(Add(steps, set(1.0F)), steps);
    way.du = Mul(Sub(u_last, u_first), longer);
    way.dv = Mul(Sub(v_last, v_first), longer);
    const V length2 =
        Div(squared_length(way.du, way.dv, filter.width, filter.height), filter.texels_per_pixel2);
    const V length = hn::Sqrt(hn::Min(length2, set(kMostTaps * kMostTaps)));
    way.taps = hn::Max(nearest(Add(length, set(kRoundUp))), whole(1));
    const M several = And(moves, float_mask(hn::Gt(way.taps, whole(1))));
    way.u = hn::IfThenElse(several, Mul(set(0.5F), Add(u_first, u_last)), way.u);
    way.v = hn::IfThenElse(several, Mul(set(0.5F), Add(v_first, v_last)), way.v);
    way.du = hn::IfThenElseZero(several, way.du);
    way.dv = hn::IfThenElseZero(several, way.dv);
    way.taps = hn::IfThenElse(hn::RebindMask(DI(), several), way.taps, whole(1));
    return way;
  }

  Colour moving_texture(const Colour& lit, const TexturePoint& point, const Filter& filter,
                        const Stay& stay, M wanted) const {
    const Way way = way_of(point, filter, stay, wanted);
    const V step = Div(set(1.0F), to_float(way.taps));
    Colour sum{set(0.0F), set(0.0F), set(0.0F)};
    for (std::int32_t i = 0;; ++i) {
      const M counts = float_mask(hn::Gt(way.taps, whole(i)));
      if (hn::AllFalse(D(), And(counts, wanted))) return sum;
      const V along = Sub(Mul(set(static_cast<float>(i) + 0.5F), step), set(0.5F));
      const Texel texel = sample(shading_.scene, filter, Add(way.u, Mul(way.du, along)),
                                 Add(way.v, Mul(way.dv, along)));
      add_to(sum, light_of(shading_.table, times_texel(lit, texel)),
             hn::IfThenElseZero(counts, step));
    }
  }

  static constexpr float kMostTaps = 8.0F;
  static constexpr float kRoundUp = 0.4F;

  const Shading& shading_;
  std::span<const Layer> layers_;
  const Tile& tile_;
  std::span<const TileIds> ids_;
  std::size_t at_;
  std::size_t middle_;
  float share_;
};

}  // namespace

void shade_on(const Shading& shading, const Layer& layer, const Tile& tile, const TileIds& ids,
              TilePixels& pixels) {
  const DU du;
  for_each_vector(tile, [&](std::size_t at) HWY_ATTR {
    Colour result = colour(shading.scene.background);
    V alpha = set(1.0F);
    shade_pixels(shading, layer, tile, at, hn::Load(du, ids.id.data() + at), everywhere(), result,
                 alpha);
    hn::Store(packed(result), du, pixels.rgb.data() + at);
  });
}

void shade_mean_on(const Shading& shading, std::span<const Layer> layers, const Tile& tile,
                   std::span<const TileIds> ids, TilePixels& pixels) {
  const LightTable& table = shading.table;
  for_each_vector(tile, [&](std::size_t at) HWY_ATTR {
    const Colour light = Mean(shading, layers, tile, ids, at).light();
    hn::Store(packed(byte_of_light(table, light.r), byte_of_light(table, light.g),
                     byte_of_light(table, light.b)),
              DU(), pixels.rgb.data() + at);
  });
}

void shade_over_on(const Shading& shading, const Layer& layer, const Tile& tile, const TileIds& ids,
                   bool with_background, TileColours& colours) {
  const D d;
  for_each_vector(tile, [&](std::size_t at) HWY_ATTR {
    Colour before = colour(shading.scene.background);
    if (!with_background) {
      before = {hn::Load(d, colours.r.data() + at), hn::Load(d, colours.g.data() + at),
                hn::Load(d, colours.b.data() + at)};
    }
    Colour own = before;
    V alpha = set(1.0F);
    shade_pixels(shading, layer, tile, at, hn::Load(DU(), ids.id.data() + at), everywhere(), own,
                 alpha);
    // Triangles drawn on the background are opaque.
    const Colour after = with_background ? own : mix(before, own, alpha);
    hn::Store(after.r, d, colours.r.data() + at);
    hn::Store(after.g, d, colours.g.data() + at);
    hn::Store(after.b, d, colours.b.data() + at);
  });
}

void add_light_on(const LightTable& table, const TileColours& colours, int layers,
                  TileColours& light) {
  const D d;
  const V share = set(1.0F / static_cast<float>(layers));
  const auto add = [&](const float* from, float* to) HWY_ATTR {
    for (std::size_t i = 0; i < kTilePixels; i += lanes()) {
      const V more = Mul(light_of(table, hn::Load(d, from + i)), share);
      hn::Store(Add(hn::Load(d, to + i), more), d, to + i);
    }
  };
  add(colours.r.data(), light.r.data());
  add(colours.g.data(), light.g.data());
  add(colours.b.data(), light.b.data());
}

void encode_colours_on(const TileColours& colours, TilePixels& pixels) {
  const D d;
  const DU du;
  for (std::size_t i = 0; i < kTilePixels; i += lanes()) {
    const Colour c{hn::Load(d, colours.r.data() + i), hn::Load(d, colours.g.data() + i),
                   hn::Load(d, colours.b.data() + i)};
    hn::Store(packed(c), du, pixels.rgb.data() + i);
  }
}

void encode_light_on(const LightTable& table, const TileColours& light, TilePixels& pixels) {
  const D d;
  const DU du;
  for (std::size_t i = 0; i < kTilePixels; i += lanes()) {
    const VI r = byte_of_light(table, hn::Load(d, light.r.data() + i));
    const VI g = byte_of_light(table, hn::Load(d, light.g.data() + i));
    const VI b = byte_of_light(table, hn::Load(d, light.b.data() + i));
    hn::Store(packed(r, g, b), du, pixels.rgb.data() + i);
  }
}

void store_row_on(const std::uint32_t* pixels, int count, std::uint8_t* rgb) {
  const hn::CappedTag<std::uint8_t, 64> d;
  const int lanes8 = static_cast<int>(hn::Lanes(d));
  int i = 0;
  for (; i + lanes8 <= count; i += lanes8) {
    hn::Vec<decltype(d)> r;
    hn::Vec<decltype(d)> g;
    hn::Vec<decltype(d)> b;
    hn::Vec<decltype(d)> unused;
    hn::LoadInterleaved4(d, reinterpret_cast<const std::uint8_t*>(pixels + i), r, g, b, unused);
    hn::StoreInterleaved3(r, g, b, d, rgb + std::ptrdiff_t{3} * i);
  }
  for (; i < count; ++i) {
    for (unsigned k = 0; k < 3; ++k) {
      rgb[3 * i + static_cast<int>(k)] = static_cast<std::uint8_t>(pixels[i] >> (8 * k));
    }
  }
}

}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tether::raster {

HWY_EXPORT(shade_on);
HWY_EXPORT(shade_mean_on);
HWY_EXPORT(shade_over_on);
HWY_EXPORT(add_light_on);
HWY_EXPORT(encode_colours_on);
HWY_EXPORT(encode_light_on);
HWY_EXPORT(store_row_on);

void shade(const Shading& shading, const Layer& layer, const Tile& tile, const TileIds& ids,
           TilePixels& pixels) {
  HWY_DYNAMIC_DISPATCH(shade_on)(shading, layer, tile, ids, pixels);
}

void shade_mean(const Shading& shading, std::span<const Layer> layers, const Tile& tile,
                std::span<const TileIds> ids, TilePixels& pixels) {
  HWY_DYNAMIC_DISPATCH(shade_mean_on)(shading, layers, tile, ids, pixels);
}

void shade_over(const Shading& shading, const Layer& layer, const Tile& tile, const TileIds& ids,
                bool with_background, TileColours& colours) {
  HWY_DYNAMIC_DISPATCH(shade_over_on)(shading, layer, tile, ids, with_background, colours);
}

void add_light(const LightTable& table, const TileColours& colours, int layers,
               TileColours& light) {
  HWY_DYNAMIC_DISPATCH(add_light_on)(table, colours, layers, light);
}

void encode_colours(const TileColours& colours, TilePixels& pixels) {
  HWY_DYNAMIC_DISPATCH(encode_colours_on)(colours, pixels);
}

void encode_light(const LightTable& table, const TileColours& light, TilePixels& pixels) {
  HWY_DYNAMIC_DISPATCH(encode_light_on)(table, light, pixels);
}

void store_row(const std::uint32_t* pixels, int count, std::uint8_t* rgb) {
  HWY_DYNAMIC_DISPATCH(store_row_on)(pixels, count, rgb);
}

}  // namespace tether::raster
#endif
