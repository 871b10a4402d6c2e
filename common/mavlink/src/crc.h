#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace tether::mavlink {

/// The checksum of MAVLink: CRC-16/MCRF4XX (ITU X.25 without the final inversion).
class Crc {
 public:
  explicit Crc(std::uint16_t initial = 0xFFFF) : value_(initial) {}
  void add(std::uint8_t byte) {
    auto t = static_cast<std::uint8_t>(byte ^ (value_ & 0xFFU));
    t = static_cast<std::uint8_t>(t ^ (t << 4U));
    value_ = static_cast<std::uint16_t>((value_ >> 8U) ^ (t << 8U) ^ (t << 3U) ^ (t >> 4U));
  }
  void add(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) add(byte);
  }
  void add(std::string_view text) {
    for (const char c : text) add(static_cast<std::uint8_t>(c));
  }
  std::uint16_t value() const { return value_; }

 private:
  std::uint16_t value_;
};

}  // namespace tether::mavlink
