#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace tether::sim {

/// What each of 256 equally probable draws adds to a byte: within ±256.
using PixelDeltas = std::array<std::int16_t, 256>;

/// Which draws: two words that KeyedRandom draws.
struct DrawKey {
  std::uint32_t added = 0;
  std::uint32_t mixed_in = 0;
};

/// Adds one draw to each byte, and clamps to 0..255. The draws are the bytes of words, the lowest
/// one first. Word i is a hash of i and the key (triple32: C. Wellons, "Prospecting for hash
/// functions", 2018), at a quarter of the cost of KeyedRandom's words.
/// Computed with the processor's vectors; the result does not depend on them.
void add_drawn(const PixelDeltas& deltas, const DrawKey& key, std::span<std::uint8_t> bytes);

}  // namespace tether::sim
