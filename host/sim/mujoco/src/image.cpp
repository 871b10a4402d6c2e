#include "image.h"

#include <bit>
#include <cstring>

#ifdef __x86_64__
#include <tmmintrin.h>
#endif

namespace tether::sim {
namespace {

// Four pixels of four bytes become three words of twelve bytes.
void pack_four(const std::uint32_t* in, std::uint32_t background, std::uint8_t* out) {
  std::uint32_t p[4];
  for (int i = 0; i < 4; ++i) p[i] = in[i] != 0 ? in[i] : background;
  const std::uint32_t words[3] = {
      (p[0] & 0x00FFFFFFU) | (p[1] << 24),
      ((p[1] >> 8) & 0x0000FFFFU) | (p[2] << 16),
      ((p[2] >> 16) & 0x000000FFU) | (p[3] << 8),
  };
  std::memcpy(out, words, sizeof words);
}

// Four pixels at a time as 16 bytes, while those fit into the row: how many it has converted.
#ifdef __x86_64__
bool can_convert_most() {
  return __builtin_cpu_supports("ssse3") != 0;
}
__attribute__((target("ssse3"))) int convert_most(const std::uint32_t* in, std::uint32_t background,
                                                  int width, std::uint8_t* out) {
  const __m128i order = _mm_setr_epi8(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1);
  const __m128i behind = _mm_set1_epi32(static_cast<int>(background));
  int x = 0;
  for (; x + 8 <= width; x += 4) {
    const __m128i four = _mm_loadu_si128(reinterpret_cast<const __m128i*>(in + x));
    const __m128i untouched = _mm_cmpeq_epi32(four, _mm_setzero_si128());
    const __m128i shown = _mm_or_si128(four, _mm_and_si128(untouched, behind));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out + 3 * x), _mm_shuffle_epi8(shown, order));
  }
  return x;
}
#else
bool can_convert_most() {
  return false;
}
int convert_most(const std::uint32_t*, std::uint32_t, int, std::uint8_t*) {
  return 0;
}
#endif

void convert_row(const std::uint32_t* in, std::uint32_t background, int width, std::uint8_t* out) {
  static_assert(std::endian::native == std::endian::little);
  int x = can_convert_most() ? convert_most(in, background, width, out) : 0;
  for (; x + 4 <= width; x += 4) pack_four(in + x, background, out + 3 * x);
  for (; x < width; ++x) std::memcpy(out + 3 * x, in[x] != 0 ? in + x : &background, 3);
}

}  // namespace

void convert_to_rgb(const RawImage& raw, std::uint32_t background, std::span<std::uint8_t> rgb) {
  const auto width = static_cast<std::size_t>(raw.width_px);
  const auto height = static_cast<std::size_t>(raw.height_px);
  for (std::size_t row = 0; row < height; ++row) {
    convert_row(raw.rgba.data() + (height - 1 - row) * width, background, raw.width_px,
                rgb.data() + row * width * 3);
  }
}

}  // namespace tether::sim
