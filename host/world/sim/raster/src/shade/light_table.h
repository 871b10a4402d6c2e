#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tether::raster {

/// sRGB bytes as light and back (IEC 61966-2-1). Light is counted from 0 to kWhite: the darkest
/// bytes are 20 apart.
struct LightTable {
  static constexpr int kWhite = 65535;

  LightTable();

  std::array<float, 256> light;  ///< of each byte
  /// The byte whose colour is nearest, for each whole amount of light; some more, because four
  /// bytes at a time are read.
  std::array<std::uint8_t, kWhite + 4> byte;
};

/// The same on every machine: made without the standard library's power.
const LightTable& light_table();

}  // namespace tether::raster
