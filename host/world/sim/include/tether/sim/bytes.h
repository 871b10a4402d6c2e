#pragma once

#include <concepts>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

/// Values as bytes, for the same program on the same machine. A struct names its parts once, for
/// both directions:
///
///     TETHER_PARTS(FileLocation, file, line)
///
/// The compiler refuses a list that lacks a part. Structs without one must be plain numbers without
/// gaps, and are copied byte by byte: equal values then have equal bytes.
namespace tether::sim {

template <class T, class Plain>
concept Is = std::same_as<std::remove_const_t<T>, Plain>;

#define TETHER_PARTS(Type, ...)                    \
  void each_part(auto& io, Is<Type> auto& whole) { \
    auto& [__VA_ARGS__] = whole;                   \
    io(__VA_ARGS__);                               \
  }

/// Finds lists of parts by their names' namespace.
struct AnyIo {
  void operator()(const auto&...) const {}
};
template <class T>
concept Listed = requires(const AnyIo& io, T& whole) {
  each_part(io, whole);
};

template <class T>
concept Path = std::same_as<T, std::filesystem::path>;
template <class T>
concept Variant = requires {
  std::variant_size<T>::value;
};
template <class T>
concept Pair = requires(T& both) {
  both.first, both.second;
};
/// Of one value, or of none.
template <class T>
concept Optional = !std::is_pointer_v<T> && requires(T & value) {
  *value, value.reset();
};
/// Plain numbers.
template <class T>
concept Gapless =
    std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && !std::same_as<T, std::string_view>;

class ByteWriter {
 public:
  void operator()(const auto&... parts) { (write(parts), ...); }
  std::string take() { return std::move(bytes_); }

 private:
  template <class T>
  void write(const T& value) {
    if constexpr (Listed<T>) {
      each_part(*this, value);
    } else if constexpr (Path<T>) {
      write(value.native());
    } else if constexpr (Variant<T>) {
      write(value.index());
      std::visit([&](const auto& one) { write(one); }, value);
    } else if constexpr (Optional<T>) {
      write(static_cast<bool>(value));
      if (value) write(*value);
    } else if constexpr (Pair<T>) {
      (*this)(value.first, value.second);
    } else if constexpr (Gapless<T>) {
      bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    } else {  // texts, lists, sets, maps
      write(value.size());
      for (const auto& item : value) write(item);
    }
  }

  std::string bytes_;
};

/// Reads what a ByteWriter wrote. @throws std::out_of_range where the bytes end too early, or
/// are none of their type's.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  void operator()(auto&... parts) { (read(parts), ...); }
  bool is_at_end() const { return bytes_.empty(); }

 private:
  static void require(bool holds) {
    if (!holds) throw std::out_of_range("not what was written");
  }
  template <class T>
  T next() {
    T result{};
    read(result);
    return result;
  }

  template <class T>
  void read(T& value) {
    if constexpr (Listed<T>) {
      each_part(*this, value);
    } else if constexpr (Path<T>) {
      value = next<std::string>();
    } else if constexpr (Variant<T>) {
      read_alternative(value, next<std::size_t>());
    } else if constexpr (Optional<T>) {
      value.reset();
      if (next<bool>()) set(value);
    } else if constexpr (Pair<T>) {
      (*this)(value.first, value.second);
    } else if constexpr (std::same_as<T, bool>) {
      const auto byte = next<unsigned char>();
      require(byte <= 1);
      value = byte == 1;
    } else if constexpr (Gapless<T>) {
      require(bytes_.size() >= sizeof value);
      std::memcpy(static_cast<void*>(&value), bytes_.data(), sizeof value);
      bytes_.remove_prefix(sizeof value);
    } else {
      value.clear();
      std::size_t left = next<std::size_t>();
      require(left <= bytes_.size());  // each item has a byte at least
      for (; left > 0; --left) value.insert(value.end(), next<Item<T>>());
    }
  }

  template <class T>
  void set(std::optional<T>& value) {
    value = next<T>();
  }
  template <class T>
  void set(std::shared_ptr<const T>& value) {
    value = std::make_shared<const T>(next<T>());
  }
  template <class... Ts>
  void read_alternative(std::variant<Ts...>& value, std::size_t index) {
    require(index < sizeof...(Ts));
    std::size_t at = 0;
    (void)((at++ == index && (value = next<Ts>(), true)) || ...);
  }

  /// Of a list or a set; of a map, which has constant keys.
  template <class T>
  struct ItemOf {
    using Type = typename T::value_type;
  };
  template <class Key, class T>
  struct ItemOf<std::map<Key, T>> {
    using Type = std::pair<Key, T>;
  };
  template <class T>
  using Item = typename ItemOf<T>::Type;

  std::string_view bytes_;
};

}  // namespace tether::sim
