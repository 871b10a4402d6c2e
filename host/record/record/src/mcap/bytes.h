#pragma once

#include "damage.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

/// Little-endian fields of MCAP records (https://mcap.dev/spec, "Serialization").
namespace tether::record {

/// Appends the `Size` low bytes of `value`, least significant first.
template <std::size_t Size>
void append_uint(std::string& out, std::uint64_t value) {
  char bytes[Size];
  for (std::size_t i = 0; i < Size; ++i) {
    bytes[i] = static_cast<char>(static_cast<unsigned char>(value >> (8 * i)));
  }
  out.append(bytes, Size);
}
inline void append_u8(std::string& out, std::uint8_t value) {
  append_uint<1>(out, value);
}
inline void append_u16(std::string& out, std::uint16_t value) {
  append_uint<2>(out, value);
}
inline void append_u32(std::string& out, std::uint32_t value) {
  append_uint<4>(out, value);
}
inline void append_u64(std::string& out, std::uint64_t value) {
  append_uint<8>(out, value);
}

/// A string with its length in 32 bits before it.
inline void append_string(std::string& out, std::string_view text) {
  append_u32(out, static_cast<std::uint32_t>(text.size()));
  out.append(text);
}

/// Writes a 64-bit field into bytes that are there already.
inline void patch_u64(std::string& bytes, std::size_t offset, std::uint64_t value) {
  for (std::size_t i = 0; i < 8; ++i) {
    bytes[offset + i] = static_cast<char>(static_cast<unsigned char>(value >> (8 * i)));
  }
}

/// Reads fields one after another; throws `Damage` instead of reading past the end.
class FieldReader {
 public:
  explicit FieldReader(std::string_view bytes) : rest_(bytes) {}

  bool empty() const { return rest_.empty(); }
  std::size_t size() const { return rest_.size(); }

  std::uint8_t u8() { return static_cast<std::uint8_t>(uint<1>()); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(uint<2>()); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(uint<4>()); }
  std::uint64_t u64() { return uint<8>(); }
  /// The next `length` bytes, which the owner of the whole keeps.
  std::string_view bytes(std::uint64_t length) {
    if (length > rest_.size()) throw Damage("a field runs past the end of its record");
    const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(length));
    rest_.remove_prefix(taken.size());
    return taken;
  }
  std::string_view string() { return bytes(u32()); }
  std::string_view all() { return bytes(rest_.size()); }

 private:
  template <std::size_t Size>
  std::uint64_t uint() {
    const std::string_view raw = bytes(Size);
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < Size; ++i) {
      value |= static_cast<std::uint64_t>(static_cast<unsigned char>(raw[i])) << (8 * i);
    }
    return value;
  }

  std::string_view rest_;
};

}  // namespace tether::record
