#if defined(TETHER_RASTER_TEXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TETHER_RASTER_TEXTURE_INL_H_
#undef TETHER_RASTER_TEXTURE_INL_H_
#else
#define TETHER_RASTER_TEXTURE_INL_H_
#endif

#include "surface-inl.h"
#include "vector-inl.h"

// Textures: trilinear, repeated, in the bytes' own values.
HWY_BEFORE_NAMESPACE();
namespace tether::raster::HWY_NAMESPACE {
namespace {

// Texture coordinates, and how they change to the next pixel along x and y.
struct TexturePoint {
  V u, v;
  V u_x, u_y, v_x, v_y;
};

HWY_INLINE V change(const Facet& f, const std::array<float, 3>& over_z, V weight, V z,
                    std::size_t axis) {
  return Mul(z, Sub(set(over_z[axis]), Mul(weight, set(f.inverse_depth[axis]))));
}

HWY_INLINE TexturePoint texture_point(const Facet& f, const Spot& s) {
  const V second_x = change(f, f.second, s.second, s.z, 1);
  const V second_y = change(f, f.second, s.second, s.z, 2);
  const V third_x = change(f, f.third, s.third, s.z, 1);
  const V third_y = change(f, f.third, s.third, s.z, 2);
  const V u1 = set(f.u[1]);
  const V u2 = set(f.u[2]);
  const V v1 = set(f.v[1]);
  const V v2 = set(f.v[2]);
  return {between_corners(f.u, s),
          between_corners(f.v, s),
          Add(Mul(u1, second_x), Mul(u2, third_x)),
          Add(Mul(u1, second_y), Mul(u2, third_y)),
          Add(Mul(v1, second_x), Mul(v2, third_x)),
          Add(Mul(v1, second_y), Mul(v2, third_y))};
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

HWY_INLINE Axis axis(V at, VI size) {
  const V repeated = Sub(at, hn::Floor(at));
  const VI fixed = Sub(nearest(Mul(repeated, to_float(hn::ShiftLeft<8>(size)))), whole(128));
  const VI first = hn::ShiftRight<8>(fixed);
  return {Add(first, And(hn::BroadcastSignBit(first), size)), And(fixed, whole(0xFF))};
}

// Two numbers of 16 bits each, times one that leaves them within 16 bits.
HWY_INLINE VU times(VU pair, VI factor) {
  const DU du;
#if HWY_TARGET == HWY_SCALAR
  return Mul(pair, hn::BitCast(du, factor));
#else
  const hn::Repartition<std::uint16_t, DU> dh;
  const auto twice = hn::BitCast(dh, hn::Or(factor, hn::ShiftLeft<16>(factor)));
  return hn::BitCast(du, Mul(hn::BitCast(dh, pair), twice));
#endif
}

HWY_INLINE void add_texel(Blend& sum, VU texel, VI weight) {
  const VU low_bytes = hn::Set(DU(), 0x00FF00FFU);
  sum.red_blue = Add(sum.red_blue, times(And(texel, low_bytes), weight));
  sum.green_alpha = Add(sum.green_alpha, times(And(hn::ShiftRight<8>(texel), low_bytes), weight));
}

// Texels with their neighbours.
struct Pair {
  VU left, right;
};

HWY_INLINE Pair gather(const std::uint64_t* texels, VI at) {
  const DU du;
#if HWY_TARGET == HWY_SCALAR
  const std::uint64_t pair = texels[hn::GetLane(at)];
  return {hn::Set(du, static_cast<std::uint32_t>(pair)),
          hn::Set(du, static_cast<std::uint32_t>(pair >> 32U))};
#else
  const hn::Repartition<std::uint64_t, DU> dw;
  const hn::Repartition<std::int64_t, DI> di;
  const hn::Half<DI> half;
  const auto low = hn::GatherIndex(dw, texels, hn::PromoteTo(di, hn::LowerHalf(half, at)));
  const auto high = hn::GatherIndex(dw, texels, hn::PromoteTo(di, hn::UpperHalf(half, at)));
  const VU a = hn::BitCast(du, low);
  const VU b = hn::BitCast(du, high);
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
HWY_INLINE Blend bilinear(const std::uint64_t* texels, const Level& level, V u, V v) {
  const Axis x = axis(u, level.width);
  const Axis y = axis(v, level.height);
  const VI next = Add(y.first, whole(1));
  const VI wrapped = hn::IfThenZeroElse(hn::Eq(next, level.height), next);
  const VI column = Add(level.first_texel, x.first);
  const Pair upper = gather(texels, Add(column, Mul(y.first, level.width)));
  const Pair lower = gather(texels, Add(column, Mul(wrapped, level.width)));
  const VI both = hn::ShiftRight<8>(Add(Mul(x.share, y.share), whole(128)));
  Blend sum{hn::Zero(DU()), hn::Zero(DU())};
  add_texel(sum, upper.left, Add(Sub(Sub(whole(256), x.share), y.share), both));
  add_texel(sum, upper.right, Sub(x.share, both));
  add_texel(sum, lower.left, Sub(y.share, both));
  add_texel(sum, lower.right, both);
  return sum;
}

// The channels, times kTexelScale.
struct Texel {
  Colour colour;
  V alpha;
};
constexpr float kTexelScale = 65280.0F;

HWY_INLINE V low_half(VU pair) {
  return to_float(hn::BitCast(DI(), And(pair, hn::Set(DU(), 0xFFFFU))));
}
HWY_INLINE V high_half(VU pair) {
  return to_float(hn::BitCast(DI(), hn::ShiftRight<16>(pair)));
}

HWY_INLINE Texel from_blend(const Blend& b) {
  return {{low_half(b.red_blue), low_half(b.green_alpha), high_half(b.red_blue)},
          high_half(b.green_alpha)};
}

// Which sizes of a texture to look at, and how far from the one to the next.
struct Filter {
  VI level, next;  // rows of PreparedScene::levels
  V share;
  V texels_per_pixel2;  // of the largest size, squared; at least 1
  V width, height;      // of the largest size
};

HWY_INLINE V squared_length(V u, V v, V width, V height) {
  const V x = Mul(u, width);
  const V y = Mul(v, height);
  return Add(Mul(x, x), Mul(y, y));
}

// As OpenGL: by the longer of the changes to the next pixel along x and y.
HWY_INLINE Filter make_filter(const PreparedScene& scene, const MaterialRow& m,
                              const TexturePoint& p) {
  const LevelRow& largest = scene.levels[static_cast<std::size_t>(m.first_level)];
  Filter f;
  f.width = set(static_cast<float>(largest.width));
  f.height = set(static_cast<float>(largest.height));
  const V longer = hn::Max(squared_length(p.u_x, p.v_x, f.width, f.height),
                           squared_length(p.u_y, p.v_y, f.width, f.height));
  f.texels_per_pixel2 = hn::Min(hn::Max(longer, set(1.0F)), set(1e12F));
  f.level = f.next = whole(m.first_level);
  f.share = set(0.0F);
  if (hn::AllTrue(D(), hn::Eq(f.texels_per_pixel2, set(1.0F)))) return f;
  const V last = set(static_cast<float>(m.levels - 1));
  // Of 1 the logarithm is 0 exactly.
  const V lod = hn::Min(Mul(set(0.5F), log2(f.texels_per_pixel2)), last);
  const V low = hn::Floor(lod);
  f.share = Sub(lod, low);
  f.level = Add(f.level, nearest(low));
  f.next = hn::Min(Add(f.level, whole(1)), whole(m.first_level + m.levels - 1));
  return f;
}

HWY_INLINE Texel sample(const PreparedScene& scene, const Filter& f, V u, V v) {
  const std::uint64_t* const texels = scene.texels.data();
  const Texel texel = from_blend(bilinear(texels, level_at(scene, f.level), u, v));
  if (hn::AllTrue(D(), hn::Eq(f.share, set(0.0F)))) return texel;
  const Texel next = from_blend(bilinear(texels, level_at(scene, f.next), u, v));
  return {mix(texel.colour, next.colour, f.share), mix(texel.alpha, next.alpha, f.share)};
}

}  // namespace
}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
