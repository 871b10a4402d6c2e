#include "drawn_noise.h"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "drawn_noise.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tether::sim::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// So many bytes are drawn, then looked up, then added.
constexpr std::size_t kAtOnce = 1024;
constexpr std::size_t kBlocks = kAtOnce / sizeof(std::array<std::uint32_t, 4>);

// One word of several blocks, each in the lower half of a lane. The upper halves do not matter.
using DW = hn::CappedTag<std::uint64_t, 8>;
using Words = hn::Vec<DW>;

HWY_INLINE Words product(Words a, std::uint32_t b) {
#if HWY_TARGET == HWY_SCALAR
  return hn::Set(DW(), (hn::GetLane(a) & 0xFFFFFFFFU) * b);
#else
  const hn::Repartition<std::uint32_t, DW> d;
  return hn::MulEven(hn::BitCast(d, a), hn::Set(d, b));
#endif
}

// As `philox4x32` (tether/base/random.h), of kBlocks blocks.
void draw(const PhiloxBlock& first, std::uint64_t* words) {
  const DW d;
  const auto pair = [&](Words low, Words high) HWY_ATTR {
    return hn::Or(hn::And(low, hn::Set(d, 0xFFFFFFFFU)), hn::ShiftLeft<32>(high));
  };
  for (std::size_t i = 0; i < kBlocks; i += hn::Lanes(d)) {
    Words c0 = hn::Set(d, first.counter[0]);
    Words c1 = hn::Set(d, first.counter[1]);
    Words c2 = hn::Add(hn::Set(d, first.counter[2]), hn::Iota(d, i));
    Words c3 = hn::Set(d, first.counter[3]);
    std::array<std::uint32_t, 2> key = first.key;
    for (int round = 0; round < 10; ++round) {
      const Words p0 = product(c0, 0xD2511F53U);
      const Words p1 = product(c2, 0xCD9E8D57U);
      c0 = hn::Xor(hn::Xor(hn::ShiftRight<32>(p1), c1), hn::Set(d, key[0]));
      c2 = hn::Xor(hn::Xor(hn::ShiftRight<32>(p0), c3), hn::Set(d, key[1]));
      c1 = p1;
      c3 = p0;
      key[0] += 0x9E3779B9U;
      key[1] += 0xBB67AE85U;
    }
    hn::StoreInterleaved2(pair(c0, c1), pair(c2, c3), d, words + 2 * i);
  }
}

}  // namespace

void add_drawn_on(const PixelDeltas& deltas, PhiloxBlock first, std::span<std::uint8_t> bytes) {
  const hn::CappedTag<std::int32_t, 16> d;
  const hn::Rebind<std::uint8_t, decltype(d)> d8;
  alignas(64) std::array<std::uint64_t, kAtOnce / 8> words;
  alignas(64) std::array<std::int32_t, kAtOnce> drawn;
  alignas(64) std::array<std::uint8_t, kAtOnce> part;
  const auto* const draws = reinterpret_cast<const std::uint8_t*>(words.data());
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(kAtOnce, bytes.size()))) {
    draw(first, words.data());
    first.counter[2] += kBlocks;
    for (std::size_t i = 0; i < kAtOnce; ++i) drawn[i] = deltas[draws[i]];
    const std::size_t count = std::min(kAtOnce, bytes.size());
    std::copy_n(bytes.data(), count, part.data());
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      const auto wide = hn::ShiftLeft<8>(hn::PromoteTo(d, hn::Load(d8, part.data() + i)));
      const auto sum = hn::Add(hn::Add(wide, hn::Load(d, drawn.data() + i)), hn::Set(d, 128));
      hn::Store(hn::DemoteTo(d8, hn::ShiftRight<8>(sum)), d8, part.data() + i);
    }
    std::copy_n(part.data(), count, bytes.data());
  }
}

}  // namespace tether::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tether::sim {

HWY_EXPORT(add_drawn_on);

void add_drawn(const PixelDeltas& deltas, const PhiloxBlock& first, std::span<std::uint8_t> bytes) {
  HWY_DYNAMIC_DISPATCH(add_drawn_on)(deltas, first, bytes);
}

}  // namespace tether::sim
#endif
