#if defined(TETHER_RASTER_TEXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TETHER_RASTER_TEXTURE_INL_H_
#undef TETHER_RASTER_TEXTURE_INL_H_
#else
#define TETHER_RASTER_TEXTURE_INL_H_
#endif

#include "shade/surface-inl.h"
#include "vector-inl.h"

#include <array>
#include <cstdint>

// Textures: trilinear, repeated, in the bytes' own values.
HWY_BEFORE_NAMESPACE();
namespace tether::raster::HWY_NAMESPACE {
namespace {

// Texture coordinates, and the texels of the largest size from a pixel to the next, squared: along
// x or y, whichever are more.
struct TexturePoint {
  V u, v;
  V texels_per_pixel2;
};

// What is added to the coordinate of corner 1.
HWY_INLINE V added_at(const Facet::Coordinate& c, const Spot& s) {
  return value_at(c.added, c.low, c.high, s);
}

HWY_INLINE TexturePoint texture_point(const Facet& f, const Spot& s) {
  const V u = added_at(f.u, s);
  const V v = added_at(f.v, s);
  const auto squared_change = [&](std::size_t axis) HWY_ATTR {
    const V of_u = Sub(set(f.u.change[axis]), Mul(u, set(f.u.shrinkage[axis])));
    const V of_v = Sub(set(f.v.change[axis]), Mul(v, set(f.v.shrinkage[axis])));
    return Add(Mul(of_u, of_u), Mul(of_v, of_v));
  };
  const V square = Mul(hn::Max(squared_change(0), squared_change(1)), Mul(s.z, s.z));
  return {Add(set(f.u.first), u), Add(set(f.v.first), v), hn::Min(square, set(1e12F))};
}

// Two numbers of 16 bits for each pixel: their products, and the upper halves of these.
HWY_INLINE VU times(VU a, VU b) {
  const hn::Repartition<std::uint16_t, DU> dh;
  return hn::BitCast(DU(), Mul(hn::BitCast(dh, a), hn::BitCast(dh, b)));
}
HWY_INLINE VU times_high(VU a, VU b) {
  const hn::Repartition<std::uint16_t, DU> dh;
  return hn::BitCast(DU(), hn::MulHigh(hn::BitCast(dh, a), hn::BitCast(dh, b)));
}

// The same number, below 2^16, in both halves.
HWY_INLINE VU twice(std::uint32_t number) {
  return hn::Set(DU(), number << 16U | number);
}

// Where some pixels are on one size of a texture, and the weights of the four texels there.
struct Places {
  alignas(64) Lanes<std::int32_t> pair;  // of PreparedScene::texels: the left one of two
  VU rows;     // 255 in all: of the upper texels in the lowest byte, of the lower ones in the next
  VU columns;  // of the left ones in the lower half, of the right ones in the upper one: 2^14 in
               // all, or the level's share of that
};

// Half of the sum over rows and columns, for texels of 128 less than their bytes. A little more (a
// 32nd of a byte), so that white leaves a colour as it is when it is rounded.
inline constexpr std::int16_t kTexelZero = 128 * 255 / 2 + 4;

using DH = hn::Repartition<std::int16_t, DI>;
using VH = hn::Vec<DH>;

// Two pairs for every fourth pixel, by one load each: instructions that gather are no quicker, and
// those of AVX-512 slower.
template <class DB>
HWY_INLINE hn::Vec<DB> every_fourth(DB d, const TexelPair* pairs, const std::int32_t* at) {
  if constexpr (hn::MaxLanes(DB()) == 4) {
    return hn::LoadU(d, reinterpret_cast<const std::uint32_t*>(pairs + *at));
  } else {
    const hn::Half<DB> half;
    return hn::Combine(d, every_fourth(half, pairs, at + hn::Lanes(half)),
                       every_fourth(half, pairs, at));
  }
}

// Of neighbouring bytes: those of `texels`, with a sign, times those of `weights`, without one, and
// their sum. @pre It fits into 16 bits.
HWY_INLINE VH sums_of_pairs(VU weights, VU texels) {
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
  return VH{_mm512_maddubs_epi16(weights.raw, texels.raw)};
#elif HWY_TARGET == HWY_AVX2
  return VH{_mm256_maddubs_epi16(weights.raw, texels.raw)};
#elif HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_SSSE3
  return VH{_mm_maddubs_epi16(weights.raw, texels.raw)};
#else
  const DH d;
  const VH w = hn::BitCast(d, weights);
  const VH t = hn::BitCast(d, texels);
  const hn::RebindToUnsigned<DH> du;
  const VH second = hn::BitCast(d, hn::ShiftRight<8>(hn::BitCast(du, w)));
  return Add(Mul(And(w, hn::Set(d, 0xFF)), hn::ShiftRight<8>(hn::ShiftLeft<8>(t))),
             Mul(second, hn::ShiftRight<8>(t)));
#endif
}

// Four numbers for each 128 bits of a vector.
template <std::uint32_t kA, std::uint32_t kB, std::uint32_t kC, std::uint32_t kD>
HWY_INLINE VU four() {
  alignas(64) static constexpr std::array<std::uint32_t, kMaxLanes> kAll{
      kA, kB, kC, kD, kA, kB, kC, kD, kA, kB, kC, kD, kA, kB, kC, kD};
  return hn::Load(DU(), kAll.data());
}

// The channels of some pixels, from 0 to kTexelWhite: of the first two of every four pixels, and of
// the other two.
struct Texels {
  VH first, second;
};

// Of every fourth pixel from the one with the number kNumber on: the four channels of the left
// texels and of the right ones, weighted.
template <std::uint32_t kNumber>
HWY_INLINE VH weighted(const TexelPair* pairs, const Places& from) {
  constexpr std::uint32_t kRows = 0x01000100U + 0x04040404U * kNumber;
  constexpr std::uint32_t kRight = kRows + 0x02020202U;
  const VU rows = hn::TableLookupBytes(from.rows, four<kRows, kRows, kRows, kRows>());
  const VU columns = hn::TableLookupBytes(from.columns, four<kRows, kRows, kRight, kRight>());
  const VU texels = every_fourth(DU(), pairs, from.pair.data() + kNumber);
  return hn::MulFixedPoint15(sums_of_pairs(rows, texels), hn::BitCast(DH(), columns));
}
template <std::uint32_t kNumber>
HWY_INLINE VH weighted(const TexelPair* pairs, const Places& own, const Places* next) {
  const VH one = weighted<kNumber>(pairs, own);
  return next == nullptr ? one : Add(one, weighted<kNumber>(pairs, *next));
}

// The left texels and the right ones of two pixels.
HWY_INLINE VH sum_of_columns(VH a, VH b) {
  const hn::Repartition<std::uint64_t, DH> d2;
  const auto a2 = hn::BitCast(d2, a);
  const auto b2 = hn::BitCast(d2, b);
  return Add(Add(hn::BitCast(DH(), hn::InterleaveLower(d2, a2, b2)),
                 hn::BitCast(DH(), hn::InterleaveUpper(d2, a2, b2))),
             hn::Set(DH(), kTexelZero));
}

HWY_INLINE Texels mixed(const TexelPair* pairs, const Places& own, const Places* next) {
  return {sum_of_columns(weighted<0>(pairs, own, next), weighted<1>(pairs, own, next)),
          sum_of_columns(weighted<2>(pairs, own, next), weighted<3>(pairs, own, next))};
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
  return Add(
      hn::Min(log2_times_128(hn::Max(p.texels_per_pixel2, set(1.0F))), whole(256 * (m.levels - 1))),
      whole(256 * m.first_level));
}

// One size of a texture for each pixel.
struct Level {
  VI first_pair, stride;
  V width, height;
};

// The levels `row`, and those that are `next` rows on.
HWY_INLINE Level level_at(const PreparedScene& scene, VI row, std::size_t next) {
  const LevelRow* const rows = scene.levels.data() + next;
  const std::int32_t first = hn::GetLane(row);
  if (hn::AllTrue(DI(), hn::Eq(row, whole(first)))) {
    const LevelRow& one = rows[first];
    return {whole(one.first_pair), whole(one.stride), set(one.width_256ths),
            set(one.height_256ths)};
  }
  constexpr std::int32_t kNumbers = sizeof(LevelRow) / sizeof(std::int32_t);
  const VI at = Mul(row, whole(kNumbers));
  return {hn::GatherIndex(DI(), &rows->first_pair, at), hn::GatherIndex(DI(), &rows->stride, at),
          hn::GatherIndex(D(), &rows->width_256ths, at),
          hn::GatherIndex(D(), &rows->height_256ths, at)};
}

// Of `u` and `v` within 0 and 1. `share` is that of the level, in 1/256.
HWY_INLINE Places places_at(const Level& level, V u, V v, VU share) {
  const VI x = Sub(nearest(Mul(u, level.width)), whole(128));
  const VI y = Sub(nearest(Mul(v, level.height)), whole(128));
  const VI row = Mul(hn::ShiftRight<8>(y), level.stride);
  Places places;
  store(Add(Add(level.first_pair, hn::ShiftRight<8>(x)), row), places.pair);
  const VU byte = hn::Set(DU(), 0xFF);
  const VU below = And(hn::BitCast(DU(), y), byte);
  const VU right = hn::ShiftRight<2>(times(And(hn::BitCast(DU(), x), byte), share));
  places.rows = Add(Sub(hn::ShiftLeft<8>(below), below), byte);
  places.columns = hn::Or(Sub(hn::ShiftLeft<6>(share), right), hn::ShiftLeft<16>(right));
  return places;
}

// Without a texture: what the white one gives, so that it does not matter whether the pixels beside
// have textures.
inline constexpr std::int16_t kTexelWhite = kTexelZero + 2 * ((127 * 255 * 8192 + 0x4000) >> 15);
HWY_INLINE Texels white() {
  return {hn::Set(DH(), kTexelWhite), hn::Set(DH(), kTexelWhite)};
}

// What some pixels see of their textures. `level`: 256 times the row of PreparedScene::levels.
HWY_INLINE Texels sample(const PreparedScene& scene, VI level, V u, V v) {
  const TexelPair* const pairs = scene.texels.data();
  const V u_repeated = Sub(u, hn::Floor(u));
  const V v_repeated = Sub(v, hn::Floor(v));
  const VI row = hn::ShiftRight<8>(level);
  const VU share = And(hn::BitCast(DU(), level), hn::Set(DU(), 0xFF));
  const Places own =
      places_at(level_at(scene, row, 0), u_repeated, v_repeated, Sub(hn::Set(DU(), 256U), share));
  if (hn::AllTrue(DU(), hn::Eq(share, hn::Zero(DU())))) return mixed(pairs, own, nullptr);
  const Places next = places_at(level_at(scene, row, 1), u_repeated, v_repeated, share);
  return mixed(pairs, own, &next);
}

// A number within 0 and 1, in 1/32767, in the lower half.
HWY_INLINE VU share_of_32767(V x) {
  const V shifted = Add(Mul(x, set(32767.0F)), set(12582912.0F));
  return And(hn::BitCast(DU(), shifted), hn::Set(DU(), 0xFFFF));
}

// The pixels of surfaces with textures. The channels become bytes only here.
HWY_INLINE VU pixels(const Colour& c, V alpha, const Texels& t) {
  const VU red_green = hn::Or(share_of_32767(c.r), hn::ShiftLeft<16>(share_of_32767(c.g)));
  const VU blue_alpha = hn::Or(share_of_32767(c.b), hn::ShiftLeft<16>(share_of_32767(alpha)));
  const VH to_byte = hn::Set(DH(), 257);
  const auto bytes = [&](VH texels, VU light) HWY_ATTR {
    return hn::BitCast(
        DU(), hn::MulFixedPoint15(hn::MulFixedPoint15(texels, hn::BitCast(DH(), light)), to_byte));
  };
  const VU first = bytes(t.first, hn::InterleaveLower(DU(), red_green, blue_alpha));
  const VU second = bytes(t.second, hn::InterleaveUpper(DU(), red_green, blue_alpha));
  return hn::TableLookupBytes(hn::Or(first, hn::ShiftLeft<8>(second)),
                              four<0x06040200U, 0x0E0C0A08U, 0x07050301U, 0x0F0D0B09U>());
}
}  // namespace
}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
