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

// Textures: trilinear, repeated, in the bytes' own values.
HWY_BEFORE_NAMESPACE();
namespace tether::raster::HWY_NAMESPACE {
namespace {

// Texture coordinates, and how they change to the next pixel along x and y.
struct TexturePoint {
  V u, v;
  V u_x, u_y, v_x, v_y;
};

HWY_INLINE TexturePoint texture_point(const Facet& f, const Spot& s, const Weights& w) {
  const V u = added(f.u, w);
  const V v = added(f.v, w);
  const auto change = [&](float over_z, V value, std::size_t axis) HWY_ATTR {
    return Mul(s.z, Sub(set(over_z), Mul(value, set(f.inverse_depth[axis]))));
  };
  return {Add(set(f.u[0]), u), Add(set(f.v[0]), v), change(f.u_x, u, 1),
          change(f.u_y, u, 2), change(f.v_x, v, 1), change(f.v_y, v, 2)};
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

// One axis of a lookup: the first of two texels, and the share of the second in 1/256.
struct Axis {
  VI first, share;
};

HWY_INLINE Axis axis(V repeated, VI size) {
  const VI fixed = Sub(nearest(Mul(repeated, to_float(hn::ShiftLeft<8>(size)))), whole(128));
  const VI first = hn::ShiftRight<8>(fixed);
  return {Add(first, And(hn::BroadcastSignBit(first), size)), And(fixed, whole(0xFF))};
}

HWY_INLINE void add_texel(Blend& sum, VU texel, VU weight) {
  const VU low_bytes = twice(0xFFU);
  sum.red_blue = Add(sum.red_blue, times(And(texel, low_bytes), weight));
  sum.green_alpha = Add(sum.green_alpha, times(And(hn::ShiftRight<8>(texel), low_bytes), weight));
}

// Texels with their right neighbours.
struct Pair {
  VU left, right;
};

#if HWY_TARGET != HWY_SCALAR
// The pairs of texels at several places, by one load each: instructions that gather are no quicker,
// and those of AVX-512 slower.
template <class DW>
HWY_INLINE hn::Vec<DW> pairs(DW d, const std::uint32_t* texels, const std::int32_t* at) {
  if constexpr (hn::MaxLanes(DW()) == 1) {
    return hn::LoadU(d, reinterpret_cast<const std::uint64_t*>(texels + *at));
  } else {
    const hn::Half<DW> half;
    return hn::Combine(d, pairs(half, texels, at + hn::Lanes(half)), pairs(half, texels, at));
  }
}
#endif

HWY_INLINE Pair gather(const std::uint32_t* texels, VI at) {
  const DU du;
#if HWY_TARGET == HWY_SCALAR
  const std::uint32_t* const left = texels + hn::GetLane(at);
  return {hn::Set(du, left[0]), hn::Set(du, left[1])};
#else
  const hn::Repartition<std::uint64_t, DU> dw;
  alignas(64) std::array<std::int32_t, kMaxLanes> places;
  hn::Store(at, DI(), places.data());
  const VU a = hn::BitCast(du, pairs(dw, texels, places.data()));
  const VU b = hn::BitCast(du, pairs(dw, texels, places.data() + hn::Lanes(dw)));
  return {hn::ConcatEven(du, b, a), hn::ConcatOdd(du, b, a)};
#endif
}

// One size of a texture for each pixel.
struct Level {
  VI first_texel, width, height;
};

HWY_INLINE Level level_at(const PreparedScene& scene, VI row) {
  const DI di;
  const std::int32_t first = hn::GetLane(row);
  if (hn::AllTrue(di, hn::Eq(row, whole(first)))) {
    const LevelRow& one = scene.levels[static_cast<std::size_t>(first)];
    return {whole(one.first_texel), whole(one.width), whole(one.height)};
  }
  const VI at = hn::ShiftLeft<2>(row);
  static_assert(sizeof(LevelRow) == 4 * sizeof(std::int32_t));
  const std::int32_t* const rows = &scene.levels.front().first_texel;
  return {hn::GatherIndex(di, rows, at), hn::GatherIndex(di, rows + 1, at),
          hn::GatherIndex(di, rows + 2, at)};
}

// The four weights sum to 256 exactly.
HWY_INLINE Blend bilinear(const std::uint32_t* texels, const Level& level, V u, V v) {
  const Axis x = axis(u, level.width);
  const Axis y = axis(v, level.height);
  const VI stride = Add(level.width, whole(1));
  const VI at = Add(Add(level.first_texel, x.first), Mul(y.first, stride));
  const Pair upper = gather(texels, at);
  const Pair lower = gather(texels, Add(at, stride));
  const VU right = twice(x.share);
  const VU below = twice(y.share);
  const VU both = And(hn::ShiftRight<8>(Add(times(right, below), twice(128U))), twice(0xFFU));
  Blend sum{hn::Zero(DU()), hn::Zero(DU())};
  add_texel(sum, upper.left, Add(Sub(Sub(twice(256U), right), below), both));
  add_texel(sum, upper.right, Sub(right, both));
  add_texel(sum, lower.left, Sub(below, both));
  add_texel(sum, lower.right, both);
  return sum;
}

// The channels, 0..1.
struct Texel {
  Colour colour;
  V alpha;
};
constexpr float kTexelScale = 1.0F / 65280.0F;
static_assert(65280.0F * kTexelScale == 1.0F, "white leaves a surface as it is");

HWY_INLINE V low_half(VU pair) {
  return to_float(hn::BitCast(DI(), And(pair, hn::Set(DU(), 0xFFFFU))));
}
HWY_INLINE V high_half(VU pair) {
  return to_float(hn::BitCast(DI(), hn::ShiftRight<16>(pair)));
}

// Which size of a texture to look at, and how far to go to the next, in 1/256.
struct Filter {
  VI level, next_share;  // a row of PreparedScene::levels
  V texels_per_pixel2;   // of the largest size, squared; at least 1
};

HWY_INLINE V squared_length(V u, V v, V width, V height) {
  const V x = Mul(u, width);
  const V y = Mul(v, height);
  return Add(Mul(x, x), Mul(y, y));
}

// 128 times the logarithm of x ≥ 1, to 1: the exponent, and a parabola through the fraction.
HWY_INLINE V log2_times_128(V x) {
  const VI bits = Sub(hn::BitCast(DI(), x), whole(0x3F800000));
  const V fraction = Mul(to_float(And(bits, whole(0x7FFFFF))), set(1.0F / 8388608.0F));
  const V curve = Mul(Mul(fraction, Sub(set(1.0F), fraction)), set(128.0F * 0.3437F));
  return Add(Mul(to_float(bits), set(128.0F / 8388608.0F)), curve);
}

// As OpenGL: by the longer of the changes to the next pixel along x and y.
HWY_INLINE Filter make_filter(const PreparedScene& scene, const MaterialRow& m,
                              const TexturePoint& p) {
  const LevelRow& largest = scene.levels[static_cast<std::size_t>(m.first_level)];
  const V width = set(static_cast<float>(largest.width));
  const V height = set(static_cast<float>(largest.height));
  const V longer = hn::Max(squared_length(p.u_x, p.v_x, width, height),
                           squared_length(p.u_y, p.v_y, width, height));
  const V square = hn::Min(hn::Max(longer, set(1.0F)), set(1e12F));
  const VI level = hn::Min(nearest(log2_times_128(square)), whole(256 * (m.levels - 1)));
  return {Add(hn::ShiftRight<8>(level), whole(m.first_level)), And(level, whole(0xFF)), square};
}

// Of numbers up to 2^16 − 256.
HWY_INLINE VU mix(VU a, VU b, VU share) {
  return Add(Sub(a, times_high(a, share)), times_high(b, share));
}

HWY_INLINE Texel sample(const PreparedScene& scene, VI level, VI next_share, V u, V v) {
  const std::uint32_t* const texels = scene.texels.data();
  const V u_repeated = Sub(u, hn::Floor(u));
  const V v_repeated = Sub(v, hn::Floor(v));
  Blend b = bilinear(texels, level_at(scene, level), u_repeated, v_repeated);
  if (!hn::AllTrue(DI(), hn::Eq(next_share, whole(0)))) {
    const Level next_level = level_at(scene, Add(level, whole(1)));
    const Blend next = bilinear(texels, next_level, u_repeated, v_repeated);
    const VU share = twice(hn::ShiftLeft<8>(next_share));
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
