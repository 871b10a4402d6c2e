#if defined(TETHER_RASTER_TEXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TETHER_RASTER_TEXTURE_INL_H_
#undef TETHER_RASTER_TEXTURE_INL_H_
#else
#define TETHER_RASTER_TEXTURE_INL_H_
#endif

#include "surface-inl.h"
#include "vector-inl.h"

#include <array>
#include <cstdint>

#include <hwy/cache_control.h>

// Textures: trilinear, repeated, in the bytes' own values.
HWY_BEFORE_NAMESPACE();
namespace tether::raster::HWY_NAMESPACE {
namespace {

// Texture coordinates, and the texels of the largest size from a pixel to the next, squared: along
// x or y, whichever are more. At least 1.
struct TexturePoint {
  V u, v;
  V texels_per_pixel2;
};

HWY_INLINE TexturePoint texture_point(const Facet& f, const Spot& s) {
  const auto added = [&](const Facet::Coordinate& c)
                         HWY_ATTR { return value_at(c.added, c.low, c.high, s); };
  const V u = added(f.u);
  const V v = added(f.v);
  const auto squared_change = [&](std::size_t axis) HWY_ATTR {
    const V of_u = Sub(set(f.u.change[axis]), Mul(u, set(f.u.shrinkage[axis])));
    const V of_v = Sub(set(f.v.change[axis]), Mul(v, set(f.v.shrinkage[axis])));
    return Add(Mul(of_u, of_u), Mul(of_v, of_v));
  };
  const V square = Mul(hn::Max(squared_change(0), squared_change(1)), Mul(s.z, s.z));
  return {Add(set(f.u.first), u), Add(set(f.v.first), v),
          hn::Min(hn::Max(square, set(1.0F)), set(1e12F))};
}

// Two numbers of 16 bits for each pixel: their products, and the upper halves of these.
HWY_INLINE VU times(VU a, VU b) {
#if HWY_TARGET == HWY_SCALAR
  const std::uint32_t x = hn::GetLane(a);
  const std::uint32_t y = hn::GetLane(b);
  return hn::Set(DU(), ((x & 0xFFFFU) * (y & 0xFFFFU) & 0xFFFFU) | (x >> 16U) * (y >> 16U) << 16U);
#else
  const hn::Repartition<std::uint16_t, DU> dh;
  return hn::BitCast(DU(), Mul(hn::BitCast(dh, a), hn::BitCast(dh, b)));
#endif
}
HWY_INLINE VU times_high(VU a, VU b) {
#if HWY_TARGET == HWY_SCALAR
  const std::uint32_t x = hn::GetLane(a);
  const std::uint32_t y = hn::GetLane(b);
  return hn::Set(DU(),
                 (x & 0xFFFFU) * (y & 0xFFFFU) >> 16U | ((x >> 16U) * (y >> 16U) & 0xFFFF0000U));
#else
  const hn::Repartition<std::uint16_t, DU> dh;
  return hn::BitCast(DU(), hn::MulHigh(hn::BitCast(dh, a), hn::BitCast(dh, b)));
#endif
}

// The same number, below 2^16, in both halves.
HWY_INLINE VU twice(VI number) {
  return hn::BitCast(DU(), hn::Or(number, hn::ShiftLeft<16>(number)));
}
HWY_INLINE VU twice(std::uint32_t number) {
  return hn::Set(DU(), number << 16U | number);
}

// Four channels of up to 255·256: red and blue in the halves of one number, green and alpha in
// those of the other.
struct Blend {
  VU red_blue, green_alpha;
};

// The upper byte of each half.
HWY_INLINE VU upper_bytes(VU pair) {
#if HWY_TARGET == HWY_SCALAR
  return And(hn::ShiftRight<8>(pair), twice(0xFFU));
#else
  const hn::Repartition<std::uint16_t, DU> dh;
  return hn::BitCast(DU(), hn::ShiftRight<8>(hn::BitCast(dh, pair)));
#endif
}

HWY_INLINE void add_texel(Blend& sum, VU texel, VU weight) {
  sum.red_blue = Add(sum.red_blue, times(And(texel, twice(0xFFU)), weight));
  sum.green_alpha = Add(sum.green_alpha, times(upper_bytes(texel), weight));
}

// The four texels around some places.
struct Square {
  VU upper_left, lower_left, upper_right, lower_right;
};

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE Square square_at(const TexelPair* pairs, const std::int32_t* places) {
  const TexelPair& left = pairs[*places];
  const TexelPair& right = pairs[*places + 1];
  const DU du;
  return {hn::Set(du, left.upper), hn::Set(du, left.lower), hn::Set(du, right.upper),
          hn::Set(du, right.lower)};
}
#else
// Two pairs for every fourth pixel, by one load each: instructions that gather are no quicker, and
// those of AVX-512 slower.
template <class DB>
HWY_INLINE hn::Vec<DB> every_fourth(DB d, const TexelPair* pairs, const std::int32_t* at) {
  if constexpr (hn::MaxLanes(DB()) == 4) {
    return hn::LoadU(d, &pairs[*at].upper);
  } else {
    const hn::Half<DB> half;
    return hn::Combine(d, every_fourth(half, pairs, at + hn::Lanes(half)),
                       every_fourth(half, pairs, at));
  }
}

HWY_INLINE Square square_at(const TexelPair* pairs, const std::int32_t* places) {
  const DU d;
  const hn::Repartition<std::uint64_t, DU> d2;
  const VU a = every_fourth(d, pairs, places);
  const VU b = every_fourth(d, pairs, places + 1);
  const VU c = every_fourth(d, pairs, places + 2);
  const VU e = every_fourth(d, pairs, places + 3);
  const auto left_ab = hn::BitCast(d2, hn::InterleaveLower(d, a, b));
  const auto left_ce = hn::BitCast(d2, hn::InterleaveLower(d, c, e));
  const auto right_ab = hn::BitCast(d2, hn::InterleaveUpper(d, a, b));
  const auto right_ce = hn::BitCast(d2, hn::InterleaveUpper(d, c, e));
  return {hn::BitCast(d, hn::InterleaveLower(d2, left_ab, left_ce)),
          hn::BitCast(d, hn::InterleaveUpper(d2, left_ab, left_ce)),
          hn::BitCast(d, hn::InterleaveLower(d2, right_ab, right_ce)),
          hn::BitCast(d, hn::InterleaveUpper(d2, right_ab, right_ce))};
}
#endif

// One size of a texture for each pixel.
struct Level {
  VI first_pair, stride;
  V width, height;
};

HWY_INLINE Level level_at(const PreparedScene& scene, VI row) {
  Level all{whole(0), whole(0), set(0.0F), set(0.0F)};
  const VU number = hn::BitCast(DU(), Add(row, whole(1)));
  for_each_number(number, [&](std::size_t at, hn::Mask<DI> same, auto is_first) HWY_ATTR {
    const LevelRow& one = scene.levels[at];
    const Level level{whole(one.first_pair), whole(one.stride), set(one.width_256ths),
                      set(one.height_256ths)};
    if (is_first.value) {
      all = level;
      return;
    }
    const M mask = float_mask(same);
    all = {hn::IfThenElse(same, level.first_pair, all.first_pair),
           hn::IfThenElse(same, level.stride, all.stride),
           hn::IfThenElse(mask, level.width, all.width),
           hn::IfThenElse(mask, level.height, all.height)};
  });
  return all;
}

// Of `u` and `v` within 0 and 1.
HWY_INLINE void look_up(const Level& level, V u, V v, Lookup& to) {
  const VI x = Sub(nearest(Mul(u, level.width)), whole(128));
  const VI y = Sub(nearest(Mul(v, level.height)), whole(128));
  const VI row = Mul(hn::ShiftRight<8>(y), level.stride);
  store(Add(Add(level.first_pair, hn::ShiftRight<8>(x)), row), to.pair);
  store(x, to.x);
  store(y, to.y);
}

// The four weights sum to 256 exactly.
HWY_INLINE Blend bilinear(const TexelPair* pairs, const Lookup& from) {
  const VI x = load(from.x);
  const VI y = load(from.y);
  const Square square = square_at(pairs, from.pair.data());
  const VU right = twice(And(x, whole(0xFF)));
  const VU below = twice(And(y, whole(0xFF)));
  const VU both = And(hn::ShiftRight<8>(Add(times(right, below), twice(128U))), twice(0xFFU));
  Blend sum{hn::Zero(DU()), hn::Zero(DU())};
  add_texel(sum, square.upper_left, Add(Sub(Sub(twice(256U), right), below), both));
  add_texel(sum, square.upper_right, Sub(right, both));
  add_texel(sum, square.lower_left, Sub(below, both));
  add_texel(sum, square.lower_right, both);
  return sum;
}

// The channels, 0..1.
struct Texel {
  Colour colour;
  V alpha;
};
inline constexpr float kTexelScale = 1.0F / 65280.0F;
static_assert(65280.0F * kTexelScale == 1.0F, "white leaves a surface as it is");

HWY_INLINE V low_half(VU pair) {
  return to_float(hn::BitCast(DI(), And(pair, hn::Set(DU(), 0xFFFFU))));
}
HWY_INLINE V high_half(VU pair) {
  return to_float(hn::BitCast(DI(), hn::ShiftRight<16>(pair)));
}

HWY_INLINE V squared_length(V u, V v, V width, V height) {
  const V x = Mul(u, width);
  const V y = Mul(v, height);
  return Add(Mul(x, x), Mul(y, y));
}

// 128 times the logarithm of x ≥ 1, to 1: the exponent, and a parabola through the fraction.
HWY_INLINE VI log2_times_128(V x) {
  const VI bits = hn::ShiftRight<16>(Sub(hn::BitCast(DI(), x), whole(0x3F800000)));
  const VU fraction = hn::BitCast(DU(), And(bits, whole(0x7F)));
  const VU curve = times_high(times(fraction, Sub(hn::Set(DU(), 0x80U), fraction)), twice(176U));
  return Add(bits, hn::BitCast(DI(), curve));
}

// Which size of a texture to look at, and how far to go to the next: 256 times the row of
// PreparedScene::levels. As OpenGL.
HWY_INLINE VI level_of(const MaterialRow& m, const TexturePoint& p) {
  return Add(hn::Min(log2_times_128(p.texels_per_pixel2), whole(256 * (m.levels - 1))),
             whole(256 * m.first_level));
}

// Of numbers up to 2^16 − 256.
HWY_INLINE VU mix(VU a, VU b, VU share) {
  return Add(Sub(a, times_high(a, share)), times_high(b, share));
}

// Whether a level is looked at alone.
HWY_INLINE bool is_one(VI level) {
  return hn::AllTrue(DI(), hn::Eq(And(level, whole(0xFF)), whole(0)));
}

// Finds the texels of some places, on a level and the next.
HWY_INLINE void look_up(const PreparedScene& scene, VI level, V u, V v, Lookups& to) {
  const V u_repeated = Sub(u, hn::Floor(u));
  const V v_repeated = Sub(v, hn::Floor(v));
  const VI row = hn::ShiftRight<8>(level);
  look_up(level_at(scene, row), u_repeated, v_repeated, to[0]);
  if (is_one(level)) return;
  look_up(level_at(scene, Add(row, whole(1))), u_repeated, v_repeated, to[1]);
}

HWY_INLINE Texel sample(const PreparedScene& scene, VI level, const Lookups& from) {
  const TexelPair* const texels = scene.texels.data();
  Blend b = bilinear(texels, from[0]);
  if (!is_one(level)) {
    const Blend next = bilinear(texels, from[1]);
    const VU share = twice(hn::ShiftLeft<8>(And(level, whole(0xFF))));
    b = {mix(b.red_blue, next.red_blue, share), mix(b.green_alpha, next.green_alpha, share)};
  }
  const V scale = set(kTexelScale);
  return {{Mul(low_half(b.red_blue), scale), Mul(low_half(b.green_alpha), scale),
           Mul(high_half(b.red_blue), scale)},
          Mul(high_half(b.green_alpha), scale)};
}

}  // namespace
}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
