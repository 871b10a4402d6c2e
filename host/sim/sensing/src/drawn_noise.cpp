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

// So many bytes are drawn, then added.
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

struct Counters {
  Words c0, c1, c2, c3;
};

HWY_INLINE void mix(Counters& c, Words key0, Words key1) {
  const Words p0 = product(c.c0, 0xD2511F53U);
  const Words p1 = product(c.c2, 0xCD9E8D57U);
  c = {hn::Xor(hn::Xor(hn::ShiftRight<32>(p1), c.c1), key0), p1,
       hn::Xor(hn::Xor(hn::ShiftRight<32>(p0), c.c3), key1), p0};
}

// As `philox4x32` (tether/base/random.h), of kBlocks blocks; two vectors at a time, because each
// round waits for the last one.
void draw(const PhiloxBlock& first, std::uint64_t* words) {
  const DW d;
  const auto counters = [&](std::size_t i) HWY_ATTR {
    return Counters{hn::Set(d, first.counter[0]), hn::Set(d, first.counter[1]),
                    hn::Add(hn::Set(d, first.counter[2]), hn::Iota(d, i)),
                    hn::Set(d, first.counter[3])};
  };
  const auto store = [&](const Counters& c, std::uint64_t* to) HWY_ATTR {
    const auto pair = [&](Words low, Words high) HWY_ATTR {
      return hn::Or(hn::And(low, hn::Set(d, 0xFFFFFFFFU)), hn::ShiftLeft<32>(high));
    };
    hn::StoreInterleaved2(pair(c.c0, c.c1), pair(c.c2, c.c3), d, to);
  };
  for (std::size_t i = 0; i < kBlocks; i += 2 * hn::Lanes(d)) {
    Counters a = counters(i);
    Counters b = counters(i + hn::Lanes(d));
    std::array<std::uint32_t, 2> key = first.key;
    for (int round = 0; round < 10; ++round) {
      const Words key0 = hn::Set(d, key[0]);
      const Words key1 = hn::Set(d, key[1]);
      mix(a, key0, key1);
      mix(b, key0, key1);
      key[0] += 0x9E3779B9U;
      key[1] += 0xBB67AE85U;
    }
    store(a, words + 2 * i);
    store(b, words + 2 * (i + hn::Lanes(d)));
  }
}

// A table that rises: what it has at 0, and the draws before each rise by 1. Few of them are
// compared with more quickly than values are looked up.
struct Rises {
  static constexpr std::size_t kMost = 64;
  std::array<std::uint8_t, kMost> draws{};
  std::size_t count = 0;
  bool are_all = true;  // of the table

  explicit Rises(const PixelDeltas& deltas) {
    const auto [low, high] = std::minmax_element(deltas.begin(), deltas.end());
    are_all = *low >= -127 && *high <= 127;
    for (std::size_t i = 1; are_all && i < deltas.size(); ++i) {
      const int rise = deltas[i] - deltas[i - 1];
      are_all = rise >= 0 && count + static_cast<std::size_t>(rise) <= kMost;
      for (int k = 0; are_all && k < rise; ++k) draws[count++] = static_cast<std::uint8_t>(i - 1);
    }
  }
};

// Of kAtOnce bytes.
void add_rises(const Rises& rises, std::int16_t first, const std::uint8_t* draws,
               std::uint8_t* bytes) {
  const hn::CappedTag<std::uint8_t, 64> d;
  const hn::RebindToSigned<decltype(d)> di;
  const std::size_t lanes = hn::Lanes(d);
  const auto above = [&](std::size_t at) HWY_ATTR {
    return hn::BitCast(di, hn::Xor(hn::Load(d, draws + at), hn::Set(d, 0x80)));
  };
  for (std::size_t i = 0; i < kAtOnce; i += 4 * lanes) {
    const auto a = above(i);
    const auto b = above(i + lanes);
    const auto c = above(i + 2 * lanes);
    const auto e = above(i + 3 * lanes);
    auto of_a = hn::Set(di, static_cast<std::int8_t>(first));
    auto of_b = of_a;
    auto of_c = of_a;
    auto of_e = of_a;
    for (std::size_t k = 0; k < rises.count; ++k) {
      const auto limit = hn::Set(di, static_cast<std::int8_t>(rises.draws[k] ^ 0x80U));
      of_a = hn::Sub(of_a, hn::VecFromMask(di, hn::Gt(a, limit)));
      of_b = hn::Sub(of_b, hn::VecFromMask(di, hn::Gt(b, limit)));
      of_c = hn::Sub(of_c, hn::VecFromMask(di, hn::Gt(c, limit)));
      of_e = hn::Sub(of_e, hn::VecFromMask(di, hn::Gt(e, limit)));
    }
    const auto add = [&](std::size_t at, auto delta) HWY_ATTR {
      const auto zero = hn::Zero(di);
      const auto more = hn::BitCast(d, hn::Max(delta, zero));
      const auto less = hn::BitCast(d, hn::Max(hn::Sub(zero, delta), zero));
      const auto sum = hn::SaturatedAdd(hn::LoadU(d, bytes + at), more);
      hn::StoreU(hn::SaturatedSub(sum, less), d, bytes + at);
    };
    add(i, of_a);
    add(i + lanes, of_b);
    add(i + 2 * lanes, of_c);
    add(i + 3 * lanes, of_e);
  }
}

}  // namespace

void add_drawn_on(const PixelDeltas& deltas, PhiloxBlock first, std::span<std::uint8_t> bytes) {
  alignas(64) std::array<std::uint64_t, kAtOnce / 8> words;
  alignas(64) std::array<std::uint8_t, kAtOnce> part;
  const auto* const draws = reinterpret_cast<const std::uint8_t*>(words.data());
  const Rises rises(deltas);
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(kAtOnce, bytes.size()))) {
    draw(first, words.data());
    first.counter[2] += kBlocks;
    const std::size_t count = std::min(kAtOnce, bytes.size());
    if (!rises.are_all) {
      for (std::size_t i = 0; i < count; ++i) {
        bytes[i] = static_cast<std::uint8_t>(std::clamp(bytes[i] + deltas[draws[i]], 0, 255));
      }
    } else if (count == kAtOnce) {
      add_rises(rises, deltas[0], draws, bytes.data());
    } else {
      std::copy_n(bytes.data(), count, part.data());
      add_rises(rises, deltas[0], draws, part.data());
      std::copy_n(part.data(), count, bytes.data());
    }
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
