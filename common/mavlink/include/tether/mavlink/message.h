#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
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
  std::uint8_t crc_extra = 0;  ///< of names and types, so that peers with other ones differ
  std::vector<Field> fields;   ///< in the order of the payload
  std::size_t length = 0;      ///< with them; at most 255

  /// nullptr: it has none of that name.
  const Field* field(std::string_view wanted) const;
};

/// In the order of their ids. Thread-safe, as the next two, and valid for ever.
std::span<const MessageType> message_types();
/// nullptr: it is not in the table.
const MessageType* find_type(std::uint32_t id);
const MessageType* find_type(std::string_view name);

/// One message: its type, and the values of its fields, which are zero at first. A field that is
/// named must exist (a fault of the program, not of a peer: it aborts), and an index be in its
/// array.
class Message {
 public:
  explicit Message(const MessageType& type) : type_(&type) {}
  /// By its name. @pre it is in the table
  explicit Message(std::string_view type);

  const MessageType& type() const { return *type_; }
  std::string_view name() const { return type_->name; }
  bool is(std::string_view name) const { return type_->name == name; }

  /// A value, of any type but 64-bit integers exactly.
  double number(std::string_view name, std::size_t i = 0) const { return number(find(name, i), i); }
  /// Of an integer, exactly (64 bits without a sign as two's complement); others are rounded.
  std::int64_t integer(std::string_view name, std::size_t i = 0) const {
    return integer(find(name, i), i);
  }
  /// The same of a field of its type. @pre i < field.count
  double number(const Field& field, std::size_t i) const;
  std::int64_t integer(const Field& field, std::size_t i) const;
  /// Of an array of characters, up to the first NUL.
  std::string text(std::string_view name) const;

  /// Integers are rounded and brought into their range; of NaN, they are 0.
  Message& set(std::string_view name, std::floating_point auto value, std::size_t i = 0) {
    return set_number(name, value, i);
  }
  Message& set(std::string_view name, std::integral auto value, std::size_t i = 0) {
    return set_integer(name, static_cast<std::int64_t>(value), std::is_unsigned_v<decltype(value)>,
                       i);
  }
  /// Cut to the array's length.
  Message& set_text(std::string_view name, std::string_view text);

  /// Of the type's length, little-endian.
  std::span<const std::uint8_t> payload() const { return std::span(payload_).first(type_->length); }
  /// What is missing is zero, and what is too much is ignored.
  void set_payload(std::span<const std::uint8_t> bytes);

 private:
  const Field& find(std::string_view name, std::size_t i) const;
  Message& set_number(std::string_view name, double value, std::size_t i);
  Message& set_integer(std::string_view name, std::int64_t value, bool is_unsigned, std::size_t i);
  template <class T>
  T load(const Field& field, std::size_t i) const;
  template <class T>
  void store(const Field& field, std::size_t i, T value);
  /// Calls `f` with a value of the field's type.
  template <class F>
  static auto with_type(Type type, F&& f);

  const MessageType* type_;
  std::array<std::uint8_t, 255> payload_{};
};

}  // namespace tether::mavlink
