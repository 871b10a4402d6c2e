#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <tether/base/random.h>

namespace tether::sim {

/// What each of 256 equally probable draws adds to a byte: within ±256.
using PixelDeltas = std::array<std::int16_t, 256>;

/// Adds one draw to each byte, and clamps to 0..255. The draws are the bytes of the words
/// that KeyedRandom draws from `first` on, the lowest one first. Computed with the processor's
/// vectors; the result does not depend on them.
void add_drawn(const PixelDeltas& deltas, const PhiloxBlock& first, std::span<std::uint8_t> bytes);

}  // namespace tether::sim
