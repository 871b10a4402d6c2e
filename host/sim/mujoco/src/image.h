#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tether::sim {

/// An image as OpenGL gives it: rows from the bottom up, pixels R, G, B, A.
struct RawImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint32_t> rgba;

  /// A pixel's four bytes; `row` counts from the top.
  const std::uint8_t* pixel(int column, int row) const {
    const std::size_t line = static_cast<std::size_t>(height_px - 1 - row);
    const std::size_t i =
        line * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(column);
    return reinterpret_cast<const std::uint8_t*>(rgba.data() + i);
  }
};

/// Rows from the top down, pixels R, G, B. Pixels that are 0, where nothing was drawn, become
/// `background`. `rgb` holds height × width × 3 bytes.
void convert_to_rgb(const RawImage& raw, std::uint32_t background, std::span<std::uint8_t> rgb);

}  // namespace tether::sim
