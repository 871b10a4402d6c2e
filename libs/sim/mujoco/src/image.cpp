#include "image.h"

#include <bit>
#include <cstring>

namespace tether::sim {
namespace {

// Four pixels of four bytes become three words of twelve bytes.
void pack_four(const std::uint32_t* in, std::uint8_t* out) {
  const std::uint32_t words[3] = {
      (in[0] & 0x00FFFFFFU) | (in[1] << 24),
      ((in[1] >> 8) & 0x0000FFFFU) | (in[2] << 16),
      ((in[2] >> 16) & 0x000000FFU) | (in[3] << 8),
  };
  std::memcpy(out, words, sizeof words);
}

void convert_row(const std::uint32_t* in, int width, std::uint8_t* out) {
  static_assert(std::endian::native == std::endian::little);
  int x = 0;
  for (; x + 4 <= width; x += 4) pack_four(in + x, out + 3 * x);
  for (; x < width; ++x) std::memcpy(out + 3 * x, in + x, 3);
}

}  // namespace

void convert_to_rgb(const RawImage& raw, std::span<std::uint8_t> rgb) {
  const auto width = static_cast<std::size_t>(raw.width_px);
  const auto height = static_cast<std::size_t>(raw.height_px);
  for (std::size_t row = 0; row < height; ++row) {
    convert_row(raw.rgba.data() + (height - 1 - row) * width, raw.width_px,
                rgb.data() + row * width * 3);
  }
}

}  // namespace tether::sim
