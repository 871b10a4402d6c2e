#include "shade/shade.h"

#include "shade/light_table.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/shade.cpp"
#include <hwy/foreach_target.h>
//
#include "shade/batch-inl.h"
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

HWY_INLINE Colour load(const TileLight& from, const Place& at) {
  return {load(from.r.data(), at), load(from.g.data(), at), load(from.b.data(), at)};
}
HWY_INLINE void store(const Colour& c, TileLight& to, const Place& at) {
  store(c.r, to.r.data(), at);
  store(c.g, to.g.data(), at);
  store(c.b, to.b.data(), at);
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

// The mean light of a tile over the layers of an exposure. A pixel is shaded once for all layers in
// which it sees the same triangle: where that is in the middle layer, or in the nearest layer in
// which the tile sees it.
class Mean {
 public:
  Mean(const Shading& shading, const Exposed& exposed, const Tile& tile, TilePixels& pixels)
      : shading_(shading),
        exposed_(exposed),
        tile_(tile),
        pixels_(pixels),
        middle_(exposed.count / 2),
        share_(set(1.0F / static_cast<float>(exposed.count))),
        may_need_taps_(exposed.motion_px > kMotionOfOneTap_px) {
    light_.r.fill(0.0F);
    light_.g.fill(0.0F);
    light_.b.fill(0.0F);
    for (std::size_t k = 0; k < exposed_.count; ++k) always_ += once(k);
    seen_.fill(always_);
    others_.fill(0);
  }

  void add_up() {
    find_runs();
    for (const std::uint32_t key : shading_.runs.ids()) {
      collect(key);
      if (key == 0) {
        add_background();
      } else {
        add_triangle(key);
      }
    }
    encode_changed();
  }

 private:
  // A triangle in a layer.
  struct Seen {
    std::size_t layer;
    std::size_t triangle;
  };
  // The way that the texture goes under a pixel during the exposure.
  struct Way {
    V u, v;    // its middle
    V du, dv;  // its length
    VI taps;   // how many places of it are looked at: about a texel apart
  };
  using Whole = std::array<std::int32_t, kTilePixels>;

  // What a pixel counts for a layer: one, and the layer's number times kNumber. kChanged is set
  // after light was added.
  static constexpr std::int32_t kNumber = 1 << 8;
  static constexpr std::int32_t kChanged = 1 << 30;
  static constexpr std::int32_t once(std::size_t k) {
    return 1 + kNumber * static_cast<std::int32_t>(k);
  }

  void find_runs() {
    Runs& runs = shading_.runs;
    runs.clear(exposed_.primitives.size() + 1);
    for_each_run(tile_, exposed_.ids(middle_),
                 [&](std::uint32_t id, std::size_t begin, std::size_t end) {
                   runs.add(id, begin, end, middle_);
                 });
    for (std::size_t k = 0; k < exposed_.count; ++k) {
      if (k == middle_) continue;
      for_each_difference(tile_, exposed_.ids(k), exposed_.ids(middle_),
                          [&](std::uint32_t id, std::size_t begin, std::size_t end) {
                            runs.add(id, begin, end, k);
                            for (std::size_t at = begin; at < end; ++at) seen_[at] -= once(k);
                          });
    }
  }

  // The pixels that see a triangle in the middle layer, and then those that do in others.
  void collect(std::uint32_t key) {
    batch_.clear();
    nearest_ = exposed_.count;
    shading_.runs.for_each(key, [&](std::size_t begin, std::size_t end, std::size_t k) HWY_ATTR {
      if (distance(k) < distance(nearest_)) nearest_ = k;
      if (k == middle_) batch_.add(begin, end);
    });
    const std::size_t own = batch_.singles().size();
    shading_.runs.for_each(key, [&](std::size_t begin, std::size_t end, std::size_t k) HWY_ATTR {
      if (k == middle_) return;
      for (std::size_t at = begin; at < end; ++at) {
        if (others_[at] == 0) batch_.add(at);
        others_[at] += once(k);
      }
    });
    batch_.fill_up();
    const std::span<const std::int32_t> singles = batch_.singles();
    for (std::size_t i = 0; i < singles.size(); ++i) {
      const auto at = static_cast<std::size_t>(singles[i]);
      seen_of_singles_[i] = i < own ? seen_[at] : std::exchange(others_[at], 0);
    }
    if (singles.empty()) return;
    hn::StoreU(whole(seen_of_singles_[singles.size() - 1]), DI(),
               seen_of_singles_.data() + singles.size());
  }

  // What the pixels of a vector count in all layers that see the triangle.
  VI seen_at(const Place& at) const {
    if (at.places == nullptr) return hn::LoadU(DI(), seen_.data() + at.first);
    return hn::Load(DI(), seen_of_singles_.data() + (at.places - batch_.singles().data()));
  }

  void add_background() {
    const Colour background = light_of(shading_.table, background_of(shading_.scene));
    for (std::size_t i = 0; i < batch_.vectors(); ++i) {
      const Place at = batch_.place(i);
      add(background, seen_at(at), at);
    }
  }

  void add_triangle(std::uint32_t key) {
    const Seen seen{nearest_, *find(key, nearest_)};
    const MaterialRow& material = shading_.scene.materials[facet(seen).material];
    const bool may_need_taps = may_need_taps_ && material.first_level > 0;
    const Seen other = may_need_taps ? farthest_of(key, seen) : seen;
    const LayerTile on{shading_, exposed_.layer(seen.layer), tile_};
    shade_batch(on, facet(seen), batch_, [&](const Place& at, const Cell& c) HWY_ATTR {
      const VI count = seen_at(at);
      const bool is_always = hn::AllTrue(DI(), hn::Eq(count, whole(always_)));
      Way way{load(c.u), load(c.v), set(0.0F), set(0.0F), whole(1)};
      if (other.layer != seen.layer) {
        const M moves = may_move(c);
        if (!hn::AllFalse(D(), moves)) set_way(material, seen, other, count, c, at, moves, way);
      }
      if (is_always && hn::AllTrue(DI(), hn::Eq(way.taps, whole(1)))) {
        store(pixels_at(shading_.scene, material, c, way.u, way.v), pixels_.data(), at);
      } else {
        add(along(material, way, c), count, at);
      }
    });
  }

  // Adds light for all layers of a count.
  void add(const Colour& light, VI count, const Place& at) {
    Colour sum = load(light_, at);
    add_to(sum, light, Mul(to_float(And(count, whole(kNumber - 1))), share_));
    store(sum, light_, at);
    store(hn::Or(load(seen_.data(), at), whole(kChanged)), seen_.data(), at);
  }

  // The pixels to which light was added.
  void encode_changed() {
    for (std::size_t at = 0; at < kTilePixels; at += lanes()) {
      const hn::Mask<DI> changed = hn::Ne(hn::Load(DI(), seen_.data() + at), whole(always_));
      if (hn::AllFalse(DI(), changed)) continue;
      hn::BlendedStore(packed(shading_.table, load(light_, {at, nullptr})),
                       hn::RebindMask(DU(), changed), DU(), pixels_.data() + at);
    }
  }

  const Facet& facet(const Seen& seen) const {
    return exposed_.layer(seen.layer).facet(shading_.scene, seen.triangle);
  }
  std::size_t distance(std::size_t k) const {
    return k < middle_ ? middle_ - k : 2 * (k - middle_);
  }

  // A triangle in the layer that is farthest from the middle, of those in which it is placed.
  Seen farthest_of(std::uint32_t key, const Seen& seen) const {
    for (std::size_t k = 0; k < middle_; ++k) {
      for (const std::size_t layer : {exposed_.count - 1 - k, k}) {
        if (const auto triangle = find(key, layer)) return {layer, *triangle};
      }
    }
    return seen;
  }
  // In the tile's list: what else is placed depends on which tiles are drawn at once.
  std::optional<std::size_t> find(std::uint32_t key, std::size_t k) const {
    const Layer& layer = exposed_.layer(k);
    const std::vector<std::uint32_t>& list = layer.opaque[exposed_.list];
    const auto key_of = [&](std::uint32_t triangle) { return layer.keys[triangle]; };
    const auto found = std::ranges::lower_bound(list, key, {}, key_of);
    if (found == list.end() || key_of(*found) != key) return std::nullopt;
    return *found;
  }

  // Where the pixels look on the texture of a triangle in a layer, whether they see it or not.
  struct Point {
    V u, v;
  };
  Point point_in(const Seen& seen, const Place& at) const {
    const Facet& f = facet(seen);
    const Sight sight({shading_, exposed_.layer(seen.layer), tile_});
    const Spot s = spot(f.depth, sight.pixels(at));
    return {Add(set(f.u.first), added_at(f.u, s)), Add(set(f.v.first), added_at(f.v, s))};
  }

  // Whether a texture may move by a texel. A pixel of motion is at most √2 times the texels from a
  // pixel to the next.
  M may_move(const Cell& c) const {
    const auto motion = static_cast<float>(exposed_.motion_px);
    return hn::Ge(load(c.texels_per_pixel2), set(kTexel * kTexel / (2.0F * motion * motion)));
  }

  // A texture moves as fast throughout as from where its triangle is seen to the other layer.
  void set_way(const MaterialRow& material, const Seen& seen, const Seen& other, VI count,
               const Cell& c, const Place& at, M may_move, Way& way) const {
    const Point there = point_in(other, at);
    const auto layer = static_cast<float>(seen.layer);
    const V each = set(1.0F / (static_cast<float>(other.layer) - layer));
    const V u_each = Mul(Sub(there.u, way.u), each);
    const V v_each = Mul(Sub(there.v, way.v), each);
    const V each2 = Div(
        squared_length(u_each, v_each, set(material.texture_width), set(material.texture_height)),
        hn::Max(load(c.texels_per_pixel2), set(1.0F)));
    const auto all = static_cast<float>(exposed_.count);
    const M moves = And(may_move, hn::Ge(each2, set(kTexel * kTexel / (all * all))));
    if (hn::AllFalse(D(), moves)) return;
    const V layers = to_float(And(count, whole(kNumber - 1)));
    const V mean = Div(to_float(hn::ShiftRight<8>(And(count, whole(kChanged - 1)))), layers);
    const V later = hn::IfThenElseZero(moves, Sub(mean, set(layer)));
    way.u = Add(way.u, Mul(u_each, later));
    way.v = Add(way.v, Mul(v_each, later));
    way.du = hn::IfThenElseZero(moves, Mul(u_each, layers));
    way.dv = hn::IfThenElseZero(moves, Mul(v_each, layers));
    const V length = hn::IfThenElseZero(moves, Mul(hn::Sqrt(each2), layers));
    const V taps = hn::Min(Add(length, set(1.5F - kTexel)), set(kMostTaps));
    way.taps = hn::Max(nearest(taps), whole(1));
  }

  // The mean light along the way.
  Colour along(const MaterialRow& material, const Way& way, const Cell& c) const {
    const V step = Div(set(1.0F), to_float(way.taps));
    Colour sum{set(0.0F), set(0.0F), set(0.0F)};
    for (std::int32_t i = 0;; ++i) {
      const M counts = float_mask(hn::Gt(way.taps, whole(i)));
      if (hn::AllFalse(D(), counts)) return sum;
      const V place = Sub(Mul(set(static_cast<float>(i) + 0.5F), step), set(0.5F));
      const VU here = pixels_at(shading_.scene, material, c, Add(way.u, Mul(way.du, place)),
                                Add(way.v, Mul(way.dv, place)));
      add_to(sum, light_of(shading_.table, here), hn::IfThenElseZero(counts, step));
    }
  }

  static constexpr float kMostTaps = 8.0F;
  static constexpr float kTexel = 1.1F;  // a way of this many texels is looked at in two places
  // A pixel of motion is at most √2 texels, if it is aslant.
  static constexpr double kMotionOfOneTap_px = 0.75;

  const Shading& shading_;
  const Exposed& exposed_;
  const Tile& tile_;
  TilePixels& pixels_;
  std::size_t middle_;
  V share_;
  bool may_need_taps_;
  TileLight light_;
  std::size_t nearest_ = 0;  // to the middle: a layer with pixels of the present batch
  std::int32_t always_ = 0;  // what a pixel counts that sees the same in all layers
  alignas(64) Whole seen_;   // what each pixel counts that sees the same as in the middle layer
  Whole others_;  // the same of those that see a triangle, but another in the middle layer
  Batch batch_;
  alignas(64) std::array<std::int32_t, kTilePixels + kMaxLanes> seen_of_singles_;
};

}  // namespace

void shade_on(const Shading& shading, const Layer& layer, const Tile& tile, const TileIds& ids,
              TilePixels& pixels) {
  const VU background = background_of(shading.scene);
  shade_tile(
      {shading, layer, tile}, ids,
      [&](const Place& at) HWY_ATTR { store(background, pixels.data(), at); },
      [&](const Facet& facet) HWY_ATTR {
        const MaterialRow& material = shading.scene.materials[facet.material];
        return [&](const Place& at, const Cell& c)
                   HWY_ATTR { store(pixels_of(shading.scene, material, c), pixels.data(), at); };
      });
}

void shade_mean_on(const Shading& shading, const Exposed& exposed, const Tile& tile,
                   TilePixels& pixels) {
  Mean(shading, exposed, tile, pixels).add_up();
}

void shade_over_on(const Shading& shading, const Layer& layer, const Tile& tile, const TileIds& ids,
                   TilePixels& pixels) {
  shade_tile(
      {shading, layer, tile}, ids, [](const Place&) {},
      [&](const Facet& facet) HWY_ATTR {
        const MaterialRow& material = shading.scene.materials[facet.material];
        return [&](const Place& at, const Cell& c) HWY_ATTR {
          const VU own = pixels_of(shading.scene, material, c);
          store(mixed(load(pixels.data(), at), own), pixels.data(), at);
        };
      });
}

void add_light_on(const LightTable& table, const TilePixels& pixels, int layers, TileLight& light) {
  const V share = set(1.0F / static_cast<float>(layers));
  for (std::size_t i = 0; i < kTilePixels; i += lanes()) {
    Colour sum = load(light, {i, nullptr});
    add_to(sum, light_of(table, hn::Load(DU(), pixels.data() + i)), share);
    store(sum, light, {i, nullptr});
  }
}

void encode_light_on(const LightTable& table, const TileLight& light, TilePixels& pixels) {
  for (std::size_t i = 0; i < kTilePixels; i += lanes()) {
    hn::Store(packed(table, load(light, {i, nullptr})), DU(), pixels.data() + i);
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

void find_entities_on(const Layer& layer, std::span<const Primitive> by_key, const Tile& tile,
                      const TileIds& ids, TilePixels& entities) {
  for_each_run(tile, ids, [&](std::uint32_t id, std::size_t begin, std::size_t end) {
    const std::uint32_t entity =
        by_key.empty() || id == 0 ? layer.entity_of(id) : by_key[id - 1].entity;
    std::fill(entities.data() + begin, entities.data() + end, entity);
  });
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

void shade_mean(const Shading& shading, const Exposed& exposed, const Tile& tile,
                TilePixels& pixels) {
  HWY_DYNAMIC_DISPATCH(shade_mean_on)(shading, exposed, tile, pixels);
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

void find_entities(const Layer& layer, std::span<const Primitive> by_key, const Tile& tile,
                   const TileIds& ids, TilePixels& entities) {
  HWY_DYNAMIC_DISPATCH(find_entities_on)(layer, by_key, tile, ids, entities);
}

std::size_t end_of_run(std::span<const std::uint32_t> values, std::size_t begin) {
  return HWY_DYNAMIC_DISPATCH(end_of_run_on)(values, begin);
}

}  // namespace tether::raster
#endif
