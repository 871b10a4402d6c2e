#include "shade.h"

#include "light_table.h"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade.cpp"
#include <hwy/foreach_target.h>
//
#include "block-inl.h"
#include "vector-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tether::raster::HWY_NAMESPACE {
namespace {

// The light of pixels. An exposed picture of a still scene is the plain one.
HWY_INLINE Colour light_of(const LightTable& table, VU pixels) {
  const auto light = [&](VU shifted) HWY_ATTR {
    const VU byte = And(shifted, hn::Set(DU(), 0xFF));
    return hn::GatherIndex(D(), table.light.data(), hn::BitCast(DI(), byte));
  };
  return {light(pixels), light(hn::ShiftRight<8>(pixels)), light(hn::ShiftRight<16>(pixels))};
}
HWY_INLINE VI byte_of_light(const LightTable& table, V light) {
  const DI di;
  const VI amount = hn::Min(nearest(light), whole(LightTable::kWhite));
  const auto* const bytes = reinterpret_cast<const std::int32_t*>(table.byte.data());
  return And(hn::GatherOffset(di, bytes, amount), whole(0xFF));
}
HWY_INLINE VU packed(const LightTable& table, const Colour& light) {
  return packed(byte_of_light(table, light.r), byte_of_light(table, light.g),
                byte_of_light(table, light.b));
}

HWY_INLINE Colour load(const TileLight& from, std::size_t at) {
  const D d;
  return {hn::Load(d, from.r.data() + at), hn::Load(d, from.g.data() + at),
          hn::Load(d, from.b.data() + at)};
}
HWY_INLINE void store(const Colour& c, TileLight& to, std::size_t at) {
  const D d;
  hn::Store(c.r, d, to.r.data() + at);
  hn::Store(c.g, d, to.g.data() + at);
  hn::Store(c.b, d, to.b.data() + at);
}

// Pixels under others, by the opacity of these.
HWY_INLINE VU mixed(VU below, VU above) {
  const VU byte = hn::Set(DU(), 0xFF);
  const V opacity = Mul(to_float(hn::BitCast(DI(), hn::ShiftRight<24>(above))), set(1.0F / 255.0F));
  const auto channel = [&](VU from, VU to) HWY_ATTR {
    return nearest(mix(to_float(hn::BitCast(DI(), And(from, byte))),
                       to_float(hn::BitCast(DI(), And(to, byte))), opacity));
  };
  return packed(channel(below, above), channel(hn::ShiftRight<8>(below), hn::ShiftRight<8>(above)),
                channel(hn::ShiftRight<16>(below), hn::ShiftRight<16>(above)));
}

// A number of the triangles that several pixels see; 0: none.
HWY_INLINE VI of_facets(const Layer& layer, VU ids, const std::uint32_t Facet::*number) {
  VI all = whole(0);
  for_each_number(ids, [&](std::size_t index, hn::Mask<DI> same, auto) HWY_ATTR {
    all = hn::IfThenElse(same, whole(static_cast<std::int32_t>(layer.facets[index].*number)), all);
  });
  return all;
}

// The mean light of a block over some layers. A pixel that sees a triangle in the middle layer is
// shaded there once for all layers in which it sees that triangle.
class Mean {
 public:
  Mean(const Part& part, std::span<const Layer> layers, std::span<const TileIds> ids, Block& block,
       TileLight& light, TilePixels& pixels)
      : part_(part),
        layers_(layers),
        ids_(ids),
        b_(block),
        light_(light),
        pixels_(pixels),
        middle_(layers.size() / 2),
        share_(1.0F / static_cast<float>(layers.size())) {}

  void add_up() {
    const VI number = whole(static_cast<std::int32_t>(middle_));
    for_each_vector(part_, [&](std::size_t at) HWY_ATTR {
      put(number, first_, at);
      put(number, last_, at);
      put(whole(1), count_, at);
      put(of_facets(layers_[middle_], ids_in(middle_, at), &Facet::primitive), primitive_, at);
      store({set(0.0F), set(0.0F), set(0.0F)}, light_, part_.first_pixel() + at);
    });
    for (std::size_t k = 0; k < layers_.size(); ++k) {
      if (k != middle_) add_layer(k);
    }
    add_middle();
  }

 private:
  // The way that the texture goes under a pixel during the exposure.
  struct Way {
    V u, v;    // its middle
    V du, dv;  // its length
    VI taps;   // how many places of it are looked at: about a texel apart
  };
  using Whole = std::array<std::int32_t, Block::kPixels>;

  static void put(VI value, Whole& plane, std::size_t at) {
    hn::Store(value, DI(), plane.data() + at);
  }
  static VI get(const Whole& plane, std::size_t at) { return hn::Load(DI(), plane.data() + at); }
  void put_pixels(VU pixels, std::size_t at) {
    hn::Store(pixels, DU(), pixels_.data() + part_.first_pixel() + at);
  }
  VU ids_in(std::size_t layer, std::size_t at) const {
    return hn::Load(DU(), ids_[layer].id.data() + part_.first_pixel() + at);
  }
  void add(const Colour& light, V share, std::size_t at) {
    Colour sum = load(light_, part_.first_pixel() + at);
    add_to(sum, light, share);
    store(sum, light_, part_.first_pixel() + at);
  }

  Colour background_light() const { return light_of(part_.shading.table, background_of(part_)); }

  // Counts the pixels that see the same as in the middle layer, and shades the others.
  void add_layer(std::size_t k) {
    const Part part{part_.shading, layers_[k], part_.tile, ids_[k], part_.first_row, part_.rows};
    const VI number = whole(static_cast<std::int32_t>(k));
    for_each_vector(part_, [&](std::size_t at) HWY_ATTR {
      const VU ids = ids_in(k, at);
      const auto other = hn::Ne(of_facets(layers_[k], ids, &Facet::primitive), get(primitive_, at));
      const VI first = get(first_, at);
      const VI last = get(last_, at);
      put(Add(get(count_, at), hn::IfThenZeroElse(other, whole(1))), count_, at);
      put(hn::IfThenElse(other, first, hn::Min(first, number)), first_, at);
      put(hn::IfThenElse(other, last, hn::Max(last, number)), last_, at);
      put(hn::VecFromMask(DI(), other), other_, at);
      hn::Store(hn::IfThenElseZero(hn::RebindMask(DU(), other), ids), DU(), b_.ids.data() + at);
    });
    const Colour background = background_light();
    const auto add_here = [&](std::size_t at, const Colour& light) HWY_ATTR {
      const M other = float_mask(hn::Ne(get(other_, at), whole(0)));
      if (hn::AllFalse(D(), other)) return;
      add(light, hn::IfThenElseZero(other, set(share_)), at);
    };
    for_each_vector(part_, [&](std::size_t at) HWY_ATTR {
      if (hn::AllTrue(D(), is_empty(b_, at))) add_here(at, background);
    });
    shade_block(part, b_, [&](std::size_t at, VU own) HWY_ATTR {
      add_here(at, select(is_empty(b_, at), background, light_of(part_.shading.table, own)));
    });
  }

  void add_middle() {
    load_ids(part_, b_);
    light_block(part_, b_);
    const LightTable& table = part_.shading.table;
    const Colour background = background_light();
    const auto put_middle = [&](std::size_t at, const Colour& light) HWY_ATTR {
      add(light, Mul(to_float(get(count_, at)), set(share_)), at);
      put_pixels(packed(table, load(light_, part_.first_pixel() + at)), at);
    };
    for_each_vector(part_, [&](std::size_t at) HWY_ATTR {
      if (hn::AllTrue(D(), is_empty(b_, at))) put_middle(at, background);
    });
    for (const Block::Run& run : b_.runs()) {
      for (const std::size_t at : b_.places(run)) {
        const Cell& c = b_.cell(at);
        const Way way = run.is_textured ? way_at(run, c, at) : resting(c);
        if (is_still(way, at)) {
          put_pixels(pixels_at(run, c, way.u, way.v), at);
        } else {
          put_middle(at, select(is_empty(b_, at), background, along(run, way, c)));
        }
      }
    }
  }

  // Whether some pixels, all with triangles, see one place of one triangle in all layers.
  bool is_still(const Way& way, std::size_t at) const {
    const auto always = hn::Eq(get(count_, at), whole(static_cast<std::int32_t>(layers_.size())));
    const auto once = hn::Eq(way.taps, whole(1));
    return hn::AllTrue(DI(), And(always, once)) && hn::AllFalse(D(), is_empty(b_, at));
  }

  // Texture coordinates in the layers `of`, which differ from pixel to pixel. `u` and `v` have
  // those of the middle layer.
  void coordinates_in(VI of, M wanted, std::size_t at, V& u, V& v) const {
    M rest = wanted;
    for (std::size_t k = 0; !hn::AllFalse(D(), rest) && k < layers_.size(); ++k) {
      const M here = And(rest, float_mask(hn::Eq(of, whole(static_cast<std::int32_t>(k)))));
      if (hn::AllFalse(D(), here)) continue;
      rest = hn::AndNot(here, rest);
      if (k == middle_) continue;
      const Layer& layer = layers_[k];
      const Part part{part_.shading, layer, part_.tile, ids_[k], part_.first_row, part_.rows};
      const Pixels p = Sight(part).pixels(at);
      const V z =
          Div(set(1.0F), hn::Load(D(), ids_[k].inverse_depth.data() + part_.first_pixel() + at));
      const VU ids = hn::IfThenElseZero(hn::RebindMask(DU(), here), ids_in(k, at));
      for_each_number(ids, [&](std::size_t index, hn::Mask<DI> pixels, auto) HWY_ATTR {
        const M same = float_mask(pixels);
        const Facet& facet = layer.facets[index];
        const TexturePoint point = texture_point(facet, spot(facet, p, z));
        u = hn::IfThenElse(same, point.u, u);
        v = hn::IfThenElse(same, point.v, v);
      });
    }
  }

  static Way resting(const Cell& c) {
    return {load(c.u), load(c.v), set(0.0F), set(0.0F), whole(1)};
  }

  // The first and the last layer are half a step within the ends of the way.
  Way way_at(const Block::Run& run, const Cell& c, std::size_t at) const {
    const VI first = get(first_, at);
    const VI last = get(last_, at);
    Way way = resting(c);
    const auto has_texture = hn::Gt(load(c.level), whole(255));
    const M moves = float_mask(And(has_texture, hn::Lt(first, last)));
    if (hn::AllFalse(D(), moves)) return way;
    V u_first = way.u;
    V v_first = way.v;
    V u_last = way.u;
    V v_last = way.v;
    coordinates_in(first, moves, at, u_first, v_first);
    coordinates_in(last, moves, at, u_last, v_last);
    const V steps = to_float(hn::Max(Sub(last, first), whole(1)));
    const V longer = Div(Add(steps, set(1.0F)), steps);
    way.du = Mul(Sub(u_last, u_first), longer);
    way.dv = Mul(Sub(v_last, v_first), longer);
    const PreparedScene& scene = part_.shading.scene;
    const V length2 =
        Div(squared_length(way.du, way.dv, of_material(run, c, scene.materials[0].texture_width),
                           of_material(run, c, scene.materials[0].texture_height)),
            load(c.texels_per_pixel2));
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

  VU pixels_at(const Block::Run& run, const Cell& c, V u, V v) const {
    const V one = set(1.0F);
    if (!run.is_textured) return pixels(colour(c), one, white());
    return pixels(colour(c), one, sample(part_.shading.scene, load(c.level), u, v));
  }

  // The mean light along the way.
  Colour along(const Block::Run& run, const Way& way, const Cell& c) const {
    const LightTable& table = part_.shading.table;
    if (!run.is_textured) return light_of(table, pixels_at(run, c, way.u, way.v));
    const V step = Div(set(1.0F), to_float(way.taps));
    Colour sum{set(0.0F), set(0.0F), set(0.0F)};
    for (std::int32_t i = 0;; ++i) {
      const M counts = float_mask(hn::Gt(way.taps, whole(i)));
      if (hn::AllFalse(D(), counts)) return sum;
      const V place = Sub(Mul(set(static_cast<float>(i) + 0.5F), step), set(0.5F));
      const VU here =
          pixels_at(run, c, Add(way.u, Mul(way.du, place)), Add(way.v, Mul(way.dv, place)));
      add_to(sum, light_of(table, here), hn::IfThenElseZero(counts, step));
    }
  }

  static constexpr float kMostTaps = 8.0F;
  static constexpr float kRoundUp = 0.4F;

  const Part& part_;
  std::span<const Layer> layers_;
  std::span<const TileIds> ids_;
  Block& b_;
  TileLight& light_;
  TilePixels& pixels_;
  std::size_t middle_;
  float share_;
  // The layers in which a pixel sees the same triangle as in the middle one.
  alignas(64) Whole first_, last_, count_;
  alignas(64) Whole primitive_;  // the triangle in the middle layer
  alignas(64) Whole other_;      // whether it is another in the present layer
};

}  // namespace

void shade_on(const Shading& shading, const Layer& layer, const Tile& tile, const TileIds& ids,
              TilePixels& pixels) {
  Block b;
  for_each_part(shading, layer, tile, ids, [&](const Part& part) HWY_ATTR {
    load_ids(part, b);
    const VU background = background_of(part);
    const auto put = [&](std::size_t at, VU pixel) HWY_ATTR {
      hn::Store(pixel, DU(), pixels.data() + part.first_pixel() + at);
    };
    for_each_vector(part, [&](std::size_t at) HWY_ATTR { put(at, background); });
    shade_block(part, b, [&](std::size_t at, VU own) HWY_ATTR {
      put(at, hn::IfThenElse(hn::RebindMask(DU(), is_empty(b, at)), background, own));
    });
  });
}

void shade_mean_on(const Shading& shading, std::span<const Layer> layers, const Tile& tile,
                   std::span<const TileIds> ids, TilePixels& pixels) {
  Block b;
  TileLight light;
  const std::size_t middle = layers.size() / 2;
  for_each_part(shading, layers[middle], tile, ids[middle], [&](const Part& part) HWY_ATTR {
    Mean(part, layers, ids, b, light, pixels).add_up();
  });
}

void shade_over_on(const Shading& shading, const Layer& layer, const Tile& tile, const TileIds& ids,
                   TilePixels& pixels) {
  Block b;
  for_each_part(shading, layer, tile, ids, [&](const Part& part) HWY_ATTR {
    load_ids(part, b);
    shade_block<true>(part, b, [&](std::size_t at, VU own) HWY_ATTR {
      std::uint32_t* const to = pixels.data() + part.first_pixel() + at;
      const VU before = hn::Load(DU(), to);
      const VU after = mixed(before, own);
      hn::Store(hn::IfThenElse(hn::RebindMask(DU(), is_empty(b, at)), before, after), DU(), to);
    });
  });
}

void add_light_on(const LightTable& table, const TilePixels& pixels, int layers, TileLight& light) {
  const V share = set(1.0F / static_cast<float>(layers));
  for (std::size_t i = 0; i < kTilePixels; i += lanes()) {
    Colour sum = load(light, i);
    add_to(sum, light_of(table, hn::Load(DU(), pixels.data() + i)), share);
    store(sum, light, i);
  }
}

void encode_light_on(const LightTable& table, const TileLight& light, TilePixels& pixels) {
  for (std::size_t i = 0; i < kTilePixels; i += lanes()) {
    hn::Store(packed(table, load(light, i)), DU(), pixels.data() + i);
  }
}

void store_row_on(const std::uint32_t* pixels, int count, std::uint8_t* rgb) {
  const hn::CappedTag<std::uint8_t, 32> d;  // AVX-512 has no quick way to interleave 64
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

void find_entities_on(const Layer& layer, const TileIds& ids, TilePixels& entities) {
  for (std::size_t i = 0; i < kTilePixels; i += lanes()) {
    const VI entity = of_facets(layer, hn::Load(DU(), ids.id.data() + i), &Facet::entity);
    hn::Store(hn::BitCast(DU(), entity), DU(), entities.data() + i);
  }
}

std::size_t end_of_run_on(std::span<const std::uint32_t> values, std::size_t begin) {
  const VU first = hn::Set(DU(), values[begin]);
  std::size_t end = begin + 1;
  while (end + lanes() <= values.size() &&
         hn::AllTrue(DU(), hn::Eq(hn::LoadU(DU(), values.data() + end), first))) {
    end += lanes();
  }
  while (end < values.size() && values[end] == values[begin]) ++end;
  return end;
}

}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tether::raster {

HWY_EXPORT(shade_on);
HWY_EXPORT(shade_mean_on);
HWY_EXPORT(shade_over_on);
HWY_EXPORT(add_light_on);
HWY_EXPORT(encode_light_on);
HWY_EXPORT(store_row_on);
HWY_EXPORT(find_entities_on);
HWY_EXPORT(end_of_run_on);

void shade(const Shading& shading, const Layer& layer, const Tile& tile, const TileIds& ids,
           TilePixels& pixels) {
  HWY_DYNAMIC_DISPATCH(shade_on)(shading, layer, tile, ids, pixels);
}

void shade_mean(const Shading& shading, std::span<const Layer> layers, const Tile& tile,
                std::span<const TileIds> ids, TilePixels& pixels) {
  HWY_DYNAMIC_DISPATCH(shade_mean_on)(shading, layers, tile, ids, pixels);
}

void shade_over(const Shading& shading, const Layer& layer, const Tile& tile, const TileIds& ids,
                TilePixels& pixels) {
  HWY_DYNAMIC_DISPATCH(shade_over_on)(shading, layer, tile, ids, pixels);
}

void add_light(const LightTable& table, const TilePixels& pixels, int layers, TileLight& light) {
  HWY_DYNAMIC_DISPATCH(add_light_on)(table, pixels, layers, light);
}

void encode_light(const LightTable& table, const TileLight& light, TilePixels& pixels) {
  HWY_DYNAMIC_DISPATCH(encode_light_on)(table, light, pixels);
}

void store_row(const std::uint32_t* pixels, int count, std::uint8_t* rgb) {
  HWY_DYNAMIC_DISPATCH(store_row_on)(pixels, count, rgb);
}

void find_entities(const Layer& layer, const TileIds& ids, TilePixels& entities) {
  HWY_DYNAMIC_DISPATCH(find_entities_on)(layer, ids, entities);
}

std::size_t end_of_run(std::span<const std::uint32_t> values, std::size_t begin) {
  return HWY_DYNAMIC_DISPATCH(end_of_run_on)(values, begin);
}

}  // namespace tether::raster
#endif
