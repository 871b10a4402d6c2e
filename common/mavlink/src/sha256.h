#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace tether::mavlink {

using Digest = std::array<std::uint8_t, 32>;

/// SHA-256 (FIPS 180-4) of bytes that arrive in pieces.
class Sha256 {
 public:
  Sha256& add(std::span<const std::uint8_t> bytes);
  /// Of all that was added. Nothing can be added after it.
  Digest finish();

 private:
  void add_block();

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> block_{};
  std::uint64_t count_ = 0;  // bytes so far
};

}  // namespace tether::mavlink
