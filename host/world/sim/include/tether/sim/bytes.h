#pragma once

#include <concepts>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

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
inline constexpr bool kHasGaps = Listed<T>;
template <class T>
inline constexpr bool kHasGaps<std::optional<T>> = true;
template <class A, class B>
inline constexpr bool kHasGaps<std::pair<A, B>> = true;
template <class... Ts>
inline constexpr bool kHasGaps<std::variant<Ts...>> = true;

/// What is copied byte by byte.
template <class T>
concept Flat = !kHasGaps<T> && std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> &&
               !std::same_as<T, std::string_view>;

class ByteWriter {
 public:
  template <class... Parts>
  void operator()(const Parts&... parts) {
    (write(parts), ...);
  }
  std::string take() { return std::move(bytes_); }

 private:
  template <Flat T>
  void write(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void write(const std::string& text) {
    write(text.size());
    bytes_ += text;
  }
  void write(const std::filesystem::path& path) { write(path.native()); }
  template <class T>
  void write_all(const T& items) {
    write(items.size());
    for (const auto& item : items) write(item);
  }
  template <class T>
  void write(const std::vector<T>& items) {
    write_all(items);
  }
  template <class T>
  void write(const std::set<T>& items) {
    write_all(items);
  }
  template <class Key, class T>
  void write(const std::map<Key, T>& items) {
    write_all(items);
  }
  template <class A, class B>
  void write(const std::pair<A, B>& both) {
    (*this)(both.first, both.second);
  }
  template <class T>
  void write(const std::optional<T>& value) {
    write(value.has_value());
    if (value) write(*value);
  }
  template <class T>
  void write(const std::shared_ptr<const T>& value) {
    write(value != nullptr);
    if (value) write(*value);
  }
  template <class... Ts>
  void write(const std::variant<Ts...>& value) {
    write(value.index());
    std::visit([&](const auto& one) { write(one); }, value);
  }
  template <Listed T>
  void write(const T& whole) {
    each_part(*this, whole);
  }

  std::string bytes_;
};

/// Reads what a ByteWriter wrote. @throws std::out_of_range where the bytes end too early.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <class... Parts>
  void operator()(Parts&... parts) {
    (read(parts), ...);
  }
  bool is_at_end() const { return bytes_.empty(); }

 private:
  std::string_view next(std::size_t count) {
    if (count > bytes_.size()) throw std::out_of_range("too few bytes");
    const std::string_view found = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return found;
  }
  template <class T>
  T value() {
    T result{};
    read(result);
    return result;
  }
  /// Of items, each of which has a byte at least.
  std::size_t count() {
    const auto found = value<std::size_t>();
    if (found > bytes_.size()) throw std::out_of_range("too few bytes");
    return found;
  }

  template <Flat T>
  void read(T& value) {
    std::memcpy(static_cast<void*>(&value), next(sizeof value).data(), sizeof value);
  }
  void read(std::string& text) { text = next(count()); }
  void read(std::filesystem::path& path) { path = value<std::string>(); }
  template <class T>
  void read(std::vector<T>& items) {
    items.clear();
    for (std::size_t left = count(); left > 0; --left) read(items.emplace_back());
  }
  template <class T>
  void read(std::set<T>& items) {
    items.clear();
    for (std::size_t left = count(); left > 0; --left) items.insert(items.end(), value<T>());
  }
  template <class Key, class T>
  void read(std::map<Key, T>& items) {
    items.clear();
    for (std::size_t left = count(); left > 0; --left) {
      Key key = value<Key>();
      read(items[std::move(key)]);
    }
  }
  template <class A, class B>
  void read(std::pair<A, B>& both) {
    (*this)(both.first, both.second);
  }
  template <class T>
  void read(std::optional<T>& value) {
    value.reset();
    if (this->value<bool>()) read(value.emplace());
  }
  template <class T>
  void read(std::shared_ptr<const T>& value) {
    value.reset();
    if (this->value<bool>()) value = std::make_shared<const T>(this->value<T>());
  }
  template <class... Ts>
  void read(std::variant<Ts...>& value) {
    const auto index = this->value<std::size_t>();
    if (index >= sizeof...(Ts)) throw std::out_of_range("no such alternative");
    std::size_t at = 0;
    (void)((at++ == index && (read(value.template emplace<Ts>()), true)) || ...);
  }
  template <Listed T>
  void read(T& whole) {
    each_part(*this, whole);
  }

  std::string_view bytes_;
};

}  // namespace tether::sim
