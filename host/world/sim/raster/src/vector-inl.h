#if defined(TETHER_RASTER_VECTOR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TETHER_RASTER_VECTOR_INL_H_
#undef TETHER_RASTER_VECTOR_INL_H_
#else
#define TETHER_RASTER_VECTOR_INL_H_
#endif

#include "scene/prepared_scene.h"

#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

// Numbers of several pixels at once.
//
// Every pixel's arithmetic is its own, in a fixed order, of operations that IEEE 754 rounds in one
// way only. So it does not matter how many pixels are computed at once, or by which instructions.
HWY_BEFORE_NAMESPACE();
namespace tether::raster::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, kMaxLanes>;
using DI = hn::RebindToSigned<D>;
using DU = hn::RebindToUnsigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using VU = hn::Vec<DU>;
using M = hn::Mask<D>;
using hn::Add;
using hn::And;
using hn::Div;
using hn::Mul;
using hn::Sub;

HWY_INLINE V set(float f) {
  return hn::Set(D(), f);
}
HWY_INLINE VI whole(std::int32_t i) {
  return hn::Set(DI(), i);
}
HWY_INLINE V to_float(VI i) {
  return hn::ConvertTo(D(), i);
}
// The nearest whole number, the even one of two. @pre |x| ≤ 2²². The sum has it in its lowest bits:
// the conversions of processors differ out of range.
HWY_INLINE VI nearest(V x) {
  constexpr float kShift = 12582912.0F;  // 1.5·2²³
  constexpr std::int32_t kShiftBits = 0x4B400000;
  return Sub(hn::BitCast(DI(), Add(x, set(kShift))), whole(kShiftBits));
}
// 0, 1, 2, …: the number of each lane.
HWY_INLINE V lane_numbers() {
  alignas(64) static constexpr std::array<float, kMaxLanes> kNumbers{0, 1, 2,  3,  4,  5,  6,  7,
                                                                     8, 9, 10, 11, 12, 13, 14, 15};
  return hn::Load(D(), kNumbers.data());
}
HWY_INLINE M float_mask(hn::Mask<DI> m) {
  return hn::RebindMask(D(), m);
}
HWY_INLINE std::size_t lanes() {
  return hn::Lanes(D());
}
HWY_INLINE V dot(V ax, V ay, V az, V bx, V by, V bz) {
  return Add(Add(Mul(ax, bx), Mul(ay, by)), Mul(az, bz));
}
HWY_INLINE V mix(V a, V b, V share) {
  return Add(a, Mul(Sub(b, a), share));
}

struct Colour {
  V r, g, b;
};

HWY_INLINE Colour colour(const std::array<float, 3>& c) {
  return {set(c[0]), set(c[1]), set(c[2])};
}
HWY_INLINE Colour scaled(const Colour& c, const Colour& by) {
  return {Mul(c.r, by.r), Mul(c.g, by.g), Mul(c.b, by.b)};
}
HWY_INLINE void add_to(Colour& sum, const Colour& c, V factor) {
  sum = {Add(sum.r, Mul(factor, c.r)), Add(sum.g, Mul(factor, c.g)), Add(sum.b, Mul(factor, c.b))};
}

}  // namespace
}  // namespace tether::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
