#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

/// MAVLink 2 (mavlink.io/en/guide/serialization.html): its messages as values, from one table, and
/// their frames.
namespace tether::mavlink {

enum class Type : std::uint8_t {
  kChar,
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat,
  kDouble,
};
std::size_t size_of(Type type);
/// As MAVLink writes it: "uint8_t", "float".
std::string_view name(Type type);

struct Field {
  std::string_view name;
  Type type = Type::kUint8;
  std::size_t count = 1;  ///< of its values
  bool is_array = false;
  bool is_extension = false;
  std::string_view unit;   ///< "m/s", "degE7"; empty: none
  std::size_t offset = 0;  ///< in the payload [bytes]
};

/// A kind of message: a row of the table.
struct MessageType {
  std::uint32_t id = 0;
  std::string_view name;
  std::uint8_t crc_extra = 0;   ///< of names and types, so that peers with other ones differ
  std::vector<Field> fields;    ///< in the order of the payload
  std::size_t base_length = 0;  ///< of the payload without extensions
  std::size_t length = 0;       ///< with them; at most 255

  /// nullptr: it has none of that name.
  const Field* field(std::string_view wanted) const;
};

/// In the order of their ids. Thread-safe, as the next two, and valid for ever.
std::span<const MessageType> message_types();
/// nullptr: it is not in the table.
const MessageType* find_type(std::uint32_t id);
const MessageType* find_type(std::string_view name);

}  // namespace tether::mavlink
