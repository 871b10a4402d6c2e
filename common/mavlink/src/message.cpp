#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include <tether/mavlink/message.h>

namespace tether::mavlink {
namespace {

static_assert(std::endian::native == std::endian::little);

[[noreturn]] void no_such(std::string_view what, std::string_view name) {
  std::fprintf(stderr, "tether: no MAVLink %.*s \"%.*s\"\n", static_cast<int>(what.size()),
               what.data(), static_cast<int>(name.size()), name.data());
  std::abort();
}

const MessageType& known(std::string_view name) {
  const MessageType* type = find_type(name);
  if (type == nullptr) no_such("message", name);
  return *type;
}

template <class T>
T within(double value) {
  if constexpr (std::is_floating_point_v<T>) {
    return static_cast<T>(value);
  } else {
    if (std::isnan(value)) return T{0};
    const double rounded = std::round(value);
    // The limits of 64 bits are no doubles: the next ones are beyond.
    if (rounded <= static_cast<double>(std::numeric_limits<T>::min()))
      return std::numeric_limits<T>::min();
    if (rounded >= static_cast<double>(std::numeric_limits<T>::max()))
      return std::numeric_limits<T>::max();
    return static_cast<T>(rounded);
  }
}

template <class T>
T within(std::int64_t value, bool is_unsigned) {
  if constexpr (std::is_floating_point_v<T>) {
    return is_unsigned ? static_cast<T>(static_cast<std::uint64_t>(value)) : static_cast<T>(value);
  } else {
    const auto clamp = [](auto whole) {
      if (std::cmp_less(whole, std::numeric_limits<T>::min())) return std::numeric_limits<T>::min();
      if (std::cmp_greater(whole, std::numeric_limits<T>::max()))
        return std::numeric_limits<T>::max();
      return static_cast<T>(whole);
    };
    return is_unsigned ? clamp(static_cast<std::uint64_t>(value)) : clamp(value);
  }
}

}  // namespace

template <class F>
auto Message::with_type(Type type, F&& f) {
  switch (type) {
    case Type::kInt8:
      return f(std::int8_t{});
    case Type::kInt16:
      return f(std::int16_t{});
    case Type::kUint16:
      return f(std::uint16_t{});
    case Type::kInt32:
      return f(std::int32_t{});
    case Type::kUint32:
      return f(std::uint32_t{});
    case Type::kInt64:
      return f(std::int64_t{});
    case Type::kUint64:
      return f(std::uint64_t{});
    case Type::kFloat:
      return f(float{});
    case Type::kDouble:
      return f(double{});
    case Type::kChar:
    case Type::kUint8:
      break;
  }
  return f(std::uint8_t{});
}

template <class T>
T Message::load(const Field& field, std::size_t i) const {
  T value{};
  std::memcpy(&value, payload_.data() + field.offset + i * sizeof(T), sizeof(T));
  return value;
}

template <class T>
void Message::store(const Field& field, std::size_t i, T value) {
  std::memcpy(payload_.data() + field.offset + i * sizeof(T), &value, sizeof(T));
}

Message::Message(std::string_view type) : Message(known(type)) {}

const Field& Message::find(std::string_view name, std::size_t i) const {
  const Field* field = type_->field(name);
  if (field == nullptr || i >= field->count) no_such("field", name);
  return *field;
}

double Message::number(const Field& field, std::size_t i) const {
  return with_type(field.type, [&]<class T>(T) { return static_cast<double>(load<T>(field, i)); });
}

std::int64_t Message::integer(const Field& field, std::size_t i) const {
  return with_type(field.type, [&]<class T>(T) -> std::int64_t {
    if constexpr (std::is_floating_point_v<T>)
      return within<std::int64_t>(static_cast<double>(load<T>(field, i)));
    else
      return static_cast<std::int64_t>(load<T>(field, i));
  });
}

std::string Message::text(std::string_view name) const {
  const Field& field = find(name, 0);
  const auto* begin = reinterpret_cast<const char*>(payload_.data() + field.offset);
  return {begin, std::find(begin, begin + field.count, '\0')};
}

Message& Message::set_number(std::string_view name, double value, std::size_t i) {
  const Field& field = find(name, i);
  with_type(field.type, [&]<class T>(T) { store<T>(field, i, within<T>(value)); });
  return *this;
}

Message& Message::set_integer(std::string_view name, std::int64_t value, bool is_unsigned,
                              std::size_t i) {
  const Field& field = find(name, i);
  with_type(field.type, [&]<class T>(T) { store<T>(field, i, within<T>(value, is_unsigned)); });
  return *this;
}

Message& Message::set_text(std::string_view name, std::string_view text) {
  const Field& field = find(name, 0);
  const auto begin = payload_.begin() + static_cast<std::ptrdiff_t>(field.offset);
  std::fill_n(begin, field.count, std::uint8_t{0});
  std::ranges::copy(text.substr(0, field.count), begin);
  return *this;
}

void Message::set_payload(std::span<const std::uint8_t> bytes) {
  payload_.fill(0);
  std::ranges::copy(bytes.first(std::min(bytes.size(), type_->length)), payload_.begin());
}

}  // namespace tether::mavlink
