#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <variant>
#include <vector>

#include <tether/wire/fields.h>

/// What the types of fields are in a frame: for the writer and the reader.
namespace tether::wire {

template <class T>
inline constexpr bool kIsTime = false;
template <class Rep, class Period>
inline constexpr bool kIsTime<std::chrono::duration<Rep, Period>> = true;
template <class Clock, class Duration>
inline constexpr bool kIsTime<std::chrono::time_point<Clock, Duration>> = true;

template <class T>
inline constexpr bool kIsUnion = false;
template <class... Tables>
inline constexpr bool kIsUnion<std::variant<Tables...>> = true;

template <class T>
concept Scalar = std::is_arithmetic_v<T> || std::is_enum_v<T> || kIsTime<T>;
template <class T>
concept Struct = kIsStruct<T>;
template <class T>
concept Table = HasFields<T> && !kIsStruct<T>;
template <class T>
concept Union = kIsUnion<T>;

/// The number that a scalar is in a frame.
template <Scalar T>
auto to_number(const T& value) {
  if constexpr (std::is_same_v<T, bool>) {
    return static_cast<std::uint8_t>(value);
  } else if constexpr (std::is_enum_v<T>) {
    // Enumerations are bytes in the schemas.
    return static_cast<std::uint8_t>(value);
  } else if constexpr (std::is_arithmetic_v<T>) {
    return value;
  } else if constexpr (requires { value.time_since_epoch(); }) {
    return to_number(value.time_since_epoch());
  } else {
    return static_cast<std::int64_t>(value.count());
  }
}
template <Scalar T>
using Number = decltype(to_number(T{}));

template <Scalar T>
T from_number(Number<T> number) {
  if constexpr (std::is_same_v<T, bool>) {
    return number != 0;
  } else if constexpr (std::is_enum_v<T> || std::is_arithmetic_v<T>) {
    return static_cast<T>(number);
  } else if constexpr (requires { typename T::clock; }) {
    return T(from_number<typename T::duration>(number));
  } else {
    return T(number);
  }
}

/// Whether an option of this type is among those of a field.
template <class Wanted, class... Options>
inline constexpr bool kHas = (std::is_same_v<Wanted, Options> || ...);

template <class T>
constexpr std::tuple<> default_in(const T&) {
  return {};
}
template <class T>
constexpr std::tuple<T> default_in(const Default<T>& option) {
  return {option.value};
}
template <Scalar T, class... Options>
constexpr Number<T> default_of(const Options&... options) {
  const auto found = std::tuple_cat(std::tuple<>{}, default_in(options)...);
  if constexpr (std::tuple_size_v < decltype(found) >> 0) {
    return static_cast<Number<T>>(std::get<0>(found));
  } else {
    return {};
  }
}

/// The option of this type, if there is one.
template <class Wanted, class... Options>
constexpr std::optional<Wanted> find(const Options&... options) {
  std::optional<Wanted> found;
  [[maybe_unused]] const auto look = [&found](const auto& option) {
    if constexpr (std::is_same_v<std::decay_t<decltype(option)>, Wanted>) found = option;
  };
  (look(options), ...);
  return found;
}

// --- structs ------------------------------------------------------------------------------------

/// Walks over a struct's numbers and their places. `Visit` is called with the place, and a number.
template <class Visit>
class StructWalk {
 public:
  constexpr explicit StructWalk(Visit visit) : visit_(visit) {}

  template <class T, class... Options>
  constexpr void operator()(const char*, T& value, const Options&...) {
    if constexpr (Struct<std::remove_const_t<T>>) {
      fields(*this, value);
    } else {
      constexpr std::size_t kSize = sizeof(Number<std::remove_const_t<T>>);
      at_ = (at_ + kSize - 1) / kSize * kSize;
      visit_(at_, value);
      at_ += kSize;
    }
  }
  template <class... T>
  constexpr void require(const T&...) {}

  /// The structs of the schemas have doubles in them, which align them.
  constexpr std::size_t size() const { return (at_ + 7) / 8 * 8; }

 private:
  Visit visit_;
  std::size_t at_ = 0;
};

template <Struct T>
constexpr std::size_t struct_bytes() {
  T value{};
  StructWalk walk([](std::size_t, auto&) {});
  fields(walk, value);
  return walk.size();
}

/// A struct as it is in a frame.
template <Struct T>
struct alignas(8) Packed {
  std::uint8_t bytes[struct_bytes<T>()];
};

/// @param room  zeros, as large as a Packed<T>
template <Struct T>
void pack(const T& value, std::uint8_t* room) {
  StructWalk walk([room](std::size_t at, const auto& part) {
    const auto number = to_number(part);
    std::memcpy(room + at, &number, sizeof number);
  });
  fields(walk, value);
}

template <Struct T>
void unpack(const std::uint8_t* room, T& value) {
  StructWalk walk([room](std::size_t at, auto& part) {
    using Part = std::remove_reference_t<decltype(part)>;
    Number<Part> number;
    std::memcpy(&number, room + at, sizeof number);
    part = from_number<Part>(number);
  });
  fields(walk, value);
}

}  // namespace tether::wire
