// A frame is a sequence of units of 16 × 8 pixels: two blocks of luma, one of each chroma. Each
// block of 8 × 8 samples is transformed (A.3.3 of T.81), divided by the table of quantization, and
// coded in zigzag order (F.1.2), by the tables that the standard gives as typical (K.1, K.3, K.5).
// Luma and chroma share their tables.
#include "camera/jpeg.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <numbers>

namespace tether::as_is {
namespace {

constexpr int kSide = 8, kBlock = kSide * kSide, kUnitWidth = 2 * kSide;
using Block = std::array<int, kBlock>;

// Of quality 90: a fifth of table K.1.
constexpr Block kQuantization = [] {
  Block table = {16, 11, 10, 16, 24,  40,  51,  61,  12, 12, 14, 19, 26,  58,  60,  55,
                 14, 13, 16, 24, 40,  57,  69,  56,  14, 17, 22, 29, 51,  87,  80,  62,
                 18, 22, 37, 56, 68,  109, 103, 77,  24, 35, 55, 64, 81,  104, 113, 92,
                 49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99};
  for (int& divisor : table) divisor = (divisor + 2) / 5;
  return table;
}();

// Index of the k-th coefficient: diagonals, up and down in turn.
constexpr Block kZigzag = [] {
  Block order{};
  int k = 0;
  for (int sum = 0; sum <= 2 * (kSide - 1); ++sum)
    for (int i = std::max(0, sum - kSide + 1); i <= std::min(sum, kSide - 1); ++i) {
      const int row = sum % 2 == 0 ? sum - i : i;
      order[static_cast<std::size_t>(k++)] = row * kSide + sum - row;
    }
  return order;
}();

/// Values, by the length of their code: so many of 1 bit, of 2, … (C.1).
struct Codes {
  std::array<std::uint8_t, 16> counts;
  std::span<const std::uint8_t> values;
};
constexpr std::uint8_t kDcValues[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
constexpr std::uint8_t kAcValues[] = {
    0x01, 0x02, 0x03, 0x00, 0x04, 0x11, 0x05, 0x12, 0x21, 0x31, 0x41, 0x06, 0x13, 0x51, 0x61,
    0x07, 0x22, 0x71, 0x14, 0x32, 0x81, 0x91, 0xa1, 0x08, 0x23, 0x42, 0xb1, 0xc1, 0x15, 0x52,
    0xd1, 0xf0, 0x24, 0x33, 0x62, 0x72, 0x82, 0x09, 0x0a, 0x16, 0x17, 0x18, 0x19, 0x1a, 0x25,
    0x26, 0x27, 0x28, 0x29, 0x2a, 0x34, 0x35, 0x36, 0x37, 0x38, 0x39, 0x3a, 0x43, 0x44, 0x45,
    0x46, 0x47, 0x48, 0x49, 0x4a, 0x53, 0x54, 0x55, 0x56, 0x57, 0x58, 0x59, 0x5a, 0x63, 0x64,
    0x65, 0x66, 0x67, 0x68, 0x69, 0x6a, 0x73, 0x74, 0x75, 0x76, 0x77, 0x78, 0x79, 0x7a, 0x83,
    0x84, 0x85, 0x86, 0x87, 0x88, 0x89, 0x8a, 0x92, 0x93, 0x94, 0x95, 0x96, 0x97, 0x98, 0x99,
    0x9a, 0xa2, 0xa3, 0xa4, 0xa5, 0xa6, 0xa7, 0xa8, 0xa9, 0xaa, 0xb2, 0xb3, 0xb4, 0xb5, 0xb6,
    0xb7, 0xb8, 0xb9, 0xba, 0xc2, 0xc3, 0xc4, 0xc5, 0xc6, 0xc7, 0xc8, 0xc9, 0xca, 0xd2, 0xd3,
    0xd4, 0xd5, 0xd6, 0xd7, 0xd8, 0xd9, 0xda, 0xe1, 0xe2, 0xe3, 0xe4, 0xe5, 0xe6, 0xe7, 0xe8,
    0xe9, 0xea, 0xf1, 0xf2, 0xf3, 0xf4, 0xf5, 0xf6, 0xf7, 0xf8, 0xf9, 0xfa};
constexpr Codes kDc = {{0, 1, 5, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0}, kDcValues};
constexpr Codes kAc = {{0, 2, 1, 3, 3, 2, 4, 3, 5, 5, 4, 4, 0, 0, 1, 0x7d}, kAcValues};

struct Code {
  std::uint32_t bits = 0;
  int length = 0;
};
/// The code of each value (C.2).
constexpr std::array<Code, 256> codes_of(const Codes& codes) {
  std::array<Code, 256> all{};
  std::uint32_t next = 0;
  std::size_t k = 0;
  for (int length = 1; length <= 16; ++length, next <<= 1)
    for (int i = 0; i < codes.counts[static_cast<std::size_t>(length - 1)]; ++i)
      all[codes.values[k++]] = {next++, length};
  return all;
}
constexpr std::array<Code, 256> kDcCodes = codes_of(kDc), kAcCodes = codes_of(kAc);

class Writer {
 public:
  explicit Writer(std::uint8_t* out) : begin_(out), out_(out) {}

  void bytes(std::initializer_list<int> values) {
    for (const int value : values) *out_++ = static_cast<std::uint8_t>(value);
  }
  void table(int kind, const Codes& codes) {
    bytes({0xff, 0xc4, 0, 2 + 17 + static_cast<int>(codes.values.size()), kind});
    out_ = std::ranges::copy(codes.counts, out_).out;
    out_ = std::ranges::copy(codes.values, out_).out;
  }
  // A byte of ones is followed by one of zeros, so that it is no marker.
  void bits(Code code) {
    bits_ = bits_ << code.length | code.bits;
    for (held_ += code.length; held_ >= 8; held_ -= 8) {
      const auto byte = static_cast<std::uint8_t>(bits_ >> (held_ - 8));
      *out_++ = byte;
      if (byte == 0xff) *out_++ = 0;
    }
  }
  void fill_byte() { bits({0x7f, 7}); }
  std::size_t size() const { return static_cast<std::size_t>(out_ - begin_); }

 private:
  std::uint8_t *begin_, *out_;
  std::uint64_t bits_ = 0;
  int held_ = 0;
};

constexpr int kShift = 13;

/// Of the transform: cos((2x + 1) u π / 16) / 2, and √½ of that for u = 0, in parts of 2^kShift.
const std::array<std::array<int, kSide>, kSide>& cosines() {
  static const auto kTable = [] {
    std::array<std::array<int, kSide>, kSide> table{};
    for (int u = 0; u < kSide; ++u)
      for (int x = 0; x < kSide; ++x) {
        const double scale = u == 0 ? std::numbers::sqrt2 / 4 : 0.5;
        table[static_cast<std::size_t>(u)][static_cast<std::size_t>(x)] = static_cast<int>(
            std::lround(scale * std::cos((2 * x + 1) * u * std::numbers::pi / 16) * (1 << kShift)));
      }
    return table;
  }();
  return kTable;
}

/// Of eight values, `step` apart: the halves are even and odd about the middle.
void transform(int* values, int step, int shift) {
  const auto& table = cosines();
  int even[kSide / 2], odd[kSide / 2];
  for (int x = 0; x < kSide / 2; ++x) {
    even[x] = values[x * step] + values[(kSide - 1 - x) * step];
    odd[x] = values[x * step] - values[(kSide - 1 - x) * step];
  }
  for (int u = 0; u < kSide; ++u) {
    const int* const half = u % 2 == 0 ? even : odd;
    const auto& row = table[static_cast<std::size_t>(u)];
    const int sum = row[0] * half[0] + row[1] * half[1] + row[2] * half[2] + row[3] * half[3];
    values[u * step] = (sum + (1 << (shift - 1))) >> shift;
  }
}

/// How many bits a value takes, and these (F.1.2.1).
Code magnitude(int value) {
  const auto length = static_cast<int>(std::bit_width(static_cast<unsigned>(std::abs(value))));
  const int bits = value < 0 ? value + (1 << length) - 1 : value;
  return {static_cast<std::uint32_t>(bits), length};
}

/// @param last the first coefficient of the block before, of the same component
void write_block(Block& samples, int& last, Writer& out) {
  constexpr int kExtra = 2;  // bits that are kept between the two passes
  for (int row = 0; row < kSide; ++row)
    transform(samples.data() + std::ptrdiff_t{row} * kSide, 1, kShift - kExtra);
  for (int column = 0; column < kSide; ++column)
    transform(&samples[static_cast<std::size_t>(column)], kSide, kShift + kExtra);
  const auto coefficient = [&](int k) {
    const auto at = static_cast<std::size_t>(kZigzag[static_cast<std::size_t>(k)]);
    const int value = samples[at], divisor = kQuantization[at];
    return (value < 0 ? value - divisor / 2 : value + divisor / 2) / divisor;
  };
  const int first = coefficient(0);
  const Code difference = magnitude(first - last);
  last = first;
  out.bits(kDcCodes[static_cast<std::size_t>(difference.length)]);
  out.bits(difference);
  int zeros = 0;
  for (int k = 1; k < kBlock; ++k) {
    const int value = coefficient(k);
    if (value == 0) {
      ++zeros;
      continue;
    }
    for (; zeros > 15; zeros -= 16) out.bits(kAcCodes[0xf0]);
    const Code code = magnitude(value);
    out.bits(kAcCodes[static_cast<std::size_t>(zeros << 4 | code.length)]);
    out.bits(code);
    zeros = 0;
  }
  if (zeros > 0) out.bits(kAcCodes[0]);
}

void write_header(int width_px, int height_px, Writer& out) {
  out.bytes({0xff, 0xd8, 0xff, 0xe0, 0, 16, 'J', 'F', 'I', 'F', 0, 1, 1, 0, 0, 1, 0, 1, 0, 0});
  out.bytes({0xff, 0xdb, 0, 2 + 1 + kBlock, 0});
  for (const int at : kZigzag) out.bytes({kQuantization[static_cast<std::size_t>(at)]});
  out.bytes({0xff, 0xc0, 0, 17, 8, height_px >> 8, height_px & 0xff, width_px >> 8, width_px & 0xff,
             3, 1, 0x21, 0, 2, 0x11, 0, 3, 0x11, 0});
  out.table(0x00, kDc);
  out.table(0x10, kAc);
  out.bytes({0xff, 0xda, 0, 12, 3, 1, 0, 2, 0, 3, 0, 0, 63, 0});
}

struct Unit {
  Block luma[2], blue, red;
};

// JFIF's YCbCr, full range, less 128. Beyond the image, its last pixels go on.
void take_unit(std::span<const std::uint8_t> rgb, int width_px, int height_px, int left, int top,
               Unit& unit) {
  constexpr int kHalf = 1 << 15;
  for (int y = 0; y < kSide; ++y) {
    const int line = std::min(top + y, height_px - 1) * width_px;
    for (int x = 0; x < kUnitWidth; x += 2) {
      int r = 0, g = 0, b = 0;
      for (int i = 0; i < 2; ++i) {
        const auto at = static_cast<std::size_t>(line + std::min(left + x + i, width_px - 1)) * 3;
        const int pixel[] = {rgb[at], rgb[at + 1], rgb[at + 2]};
        const int place = y * kSide + x % kSide + i;
        unit.luma[x / kSide][static_cast<std::size_t>(place)] =
            ((19595 * pixel[0] + 38470 * pixel[1] + 7471 * pixel[2] + kHalf) >> 16) - 128;
        r += pixel[0];
        g += pixel[1];
        b += pixel[2];
      }
      const int place = y * kSide + x / 2;
      const auto at = static_cast<std::size_t>(place);
      unit.blue[at] = (-11059 * r - 21709 * g + 32768 * b + 2 * kHalf) >> 17;
      unit.red[at] = (32768 * r - 27439 * g - 5329 * b + 2 * kHalf) >> 17;
    }
  }
}

}  // namespace

// A coefficient takes 16 + 11 bits at most, twice with bytes that follow those of ones.
std::size_t most_jpeg_bytes(int width_px, int height_px) {
  constexpr std::size_t kHeader = 1024, kBlocks = 4, kOfCoefficient = 8;
  const auto units = [](int pixels, int of) {
    return static_cast<std::size_t>((pixels + of - 1) / of);
  };
  return kHeader +
         units(width_px, kUnitWidth) * units(height_px, kSide) * kBlocks * kBlock * kOfCoefficient;
}

std::size_t write_jpeg(std::span<const std::uint8_t> rgb, int width_px, int height_px,
                       std::uint8_t* out) {
  Writer writer(out);
  write_header(width_px, height_px, writer);
  int luma = 0, blue = 0, red = 0;
  Unit unit;
  for (int top = 0; top < height_px; top += kSide)
    for (int left = 0; left < width_px; left += kUnitWidth) {
      take_unit(rgb, width_px, height_px, left, top, unit);
      for (Block& block : unit.luma) write_block(block, luma, writer);
      write_block(unit.blue, blue, writer);
      write_block(unit.red, red, writer);
    }
  writer.fill_byte();
  writer.bytes({0xff, 0xd9});
  return writer.size();
}

}  // namespace tether::as_is
