#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tether/mavlink/message_type.h>

namespace tether::mavlink {

/// One message: its type, and the values of its fields, which are zero at first. A field that is
/// named must exist (a fault of the program, not of a peer: it aborts), and an index be in its
/// array.
class Message {
 public:
  explicit Message(const MessageType& type) : type_(&type), payload_(type.length) {}
  /// By its name. @pre it is in the table
  explicit Message(std::string_view type);

  const MessageType& type() const { return *type_; }
  std::string_view name() const { return type_->name; }
  bool is(std::string_view name) const { return type_->name == name; }

  /// A value, of any type but 64-bit integers exactly.
  double number(std::string_view name, std::size_t i = 0) const;
  /// Of an integer, exactly (64 bits without a sign as two's complement); others are rounded.
  std::int64_t integer(std::string_view name, std::size_t i = 0) const;
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
  std::span<const std::uint8_t> payload() const { return payload_; }
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
  std::vector<std::uint8_t> payload_;
};

}  // namespace tether::mavlink
