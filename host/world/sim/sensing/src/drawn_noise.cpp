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
constexpr std::size_t kWords = kAtOnce / sizeof(std::uint32_t);

// The words from number `first` on, kWords of them.
void draw(const DrawKey& key, std::uint32_t first, std::uint32_t* words) {
  const hn::CappedTag<std::uint32_t, 16> d;
  for (std::size_t i = 0; i < kWords; i += hn::Lanes(d)) {
    auto x = hn::Add(hn::Iota(d, static_cast<std::uint32_t>(i)), hn::Set(d, first + key.added));
    x = hn::Mul(hn::Xor(x, hn::ShiftRight<17>(x)), hn::Set(d, 0xED5AD4BBU));
    x = hn::Xor(x, hn::Set(d, key.mixed_in));
    x = hn::Mul(hn::Xor(x, hn::ShiftRight<11>(x)), hn::Set(d, 0xAC4C1B51U));
    x = hn::Mul(hn::Xor(x, hn::ShiftRight<15>(x)), hn::Set(d, 0x31848BABU));
    hn::Store(hn::Xor(x, hn::ShiftRight<14>(x)), d, words + i);
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

void add_drawn_on(const PixelDeltas& deltas, const DrawKey& key, std::span<std::uint8_t> bytes) {
  alignas(64) std::array<std::uint32_t, kWords> words;
  alignas(64) std::array<std::uint8_t, kAtOnce> part;
  const auto* const draws = reinterpret_cast<const std::uint8_t*>(words.data());
  const Rises rises(deltas);
  std::uint32_t first = 0;
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(kAtOnce, bytes.size()))) {
    draw(key, first, words.data());
    first += kWords;
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

void add_drawn(const PixelDeltas& deltas, const DrawKey& key, std::span<std::uint8_t> bytes) {
  HWY_DYNAMIC_DISPATCH(add_drawn_on)(deltas, key, bytes);
}

}  // namespace tether::sim
#endif
