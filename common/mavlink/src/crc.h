#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace tether::mavlink {

/// The checksum of MAVLink: CRC-16/MCRF4XX (ITU X.25 without the final inversion).
class Crc {
 public:
  explicit Crc(std::uint16_t initial = 0xFFFF) : value_(initial) {}
  void add(std::uint8_t byte) { value_ = after(value_, byte); }
  // Two bytes at a time: what each does to the value is in a table.
  void add(std::span<const std::uint8_t> bytes) {
    for (; bytes.size() >= 2; bytes = bytes.subspan(2)) {
      const unsigned x = value_ ^ (bytes[0] | unsigned{bytes[1]} << 8U);
      value_ = kEffects.first[x & 0xFFU] ^ kEffects.second[x >> 8U];
    }
    for (const std::uint8_t byte : bytes) add(byte);
  }
  void add(std::string_view text) {
    for (const char c : text) add(static_cast<std::uint8_t>(c));
  }
  std::uint16_t value() const { return value_; }

 private:
  static constexpr std::uint16_t after(std::uint16_t value, std::uint8_t byte) {
    auto t = static_cast<std::uint8_t>(byte ^ (value & 0xFFU));
    t = static_cast<std::uint8_t>(t ^ (t << 4U));
    return static_cast<std::uint16_t>((value >> 8U) ^ (t << 8U) ^ (t << 3U) ^ (t >> 4U));
  }
  /// Of the first and the second of two bytes, on 0.
  struct Effects {
    std::array<std::uint16_t, 256> first{}, second{};
    constexpr Effects() {
      for (unsigned byte = 0; byte < 256; ++byte) {
        second[byte] = after(0, static_cast<std::uint8_t>(byte));
        first[byte] = after(second[byte], 0);
      }
    }
  };
  static const Effects kEffects;

  std::uint16_t value_;
};

inline constexpr Crc::Effects Crc::kEffects;

}  // namespace tether::mavlink
