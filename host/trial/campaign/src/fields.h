#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tether/base/time.h>

/// The two directions of `fields`, which lists the members of a part of a result once: `io` is a
/// FieldWriter or a FieldReader. The order is that of the text. Times are in seconds, to the
/// nanosecond; an optional value that is not there is null, and a structure is an object.
namespace tether::campaign {

using Json = nlohmann::ordered_json;

/// @throws Error(kBadFile) if the text is not a complete JSON document, or deeper than
/// kMaxJsonDepth.
Json parse_json(const std::string& text, const std::filesystem::path& file);

inline constexpr const char* kNotReported = "not reported";

template <class Value>
concept Time = requires(const Value& value) {
  to_ns(value);
};
// Division rounds correctly, so that every nanosecond count prints short and reads back exactly.
double exact_seconds(const Time auto& time) {
  return static_cast<double>(to_ns(time)) / 1e9;
}

template <class Value, class Plain>
concept Maybe = std::same_as<std::remove_const_t<Value>, Plain>;

template <class Value>
inline constexpr bool kIsOptional = false;
template <class Value>
inline constexpr bool kIsOptional<std::optional<Value>> = true;
template <class Value>
inline constexpr bool kIsList = false;
template <class Value>
inline constexpr bool kIsList<std::vector<Value>> = true;

class FieldWriter {
 public:
  Json json = Json::object();

  void operator()(std::string_view name, const auto& value) {
    json[std::string(name)] = json_of(value);
  }
  /// Members whose presence follows from a condition.
  static bool has(std::string_view, bool condition) { return condition; }
  template <class Value>
  static const Value& value_of(const std::optional<Value>& value) {
    return *value;
  }
  /// A member that may be absent.
  template <class Value>
  void optional(std::string_view name, const std::optional<Value>& value) {
    if (value) (*this)(name, *value);
  }
  /// A text or a list that is absent if it is empty.
  void some(std::string_view name, const auto& value) {
    if (!value.empty()) (*this)(name, value);
  }
  /// A member that results of earlier versions do not have.
  void since(std::string_view name, const auto& value) { (*this)(name, value); }
  /// A member that is written for readers other than Tether.
  void derived(std::string_view name, const auto& value) { (*this)(name, value); }
  /// What has another place in the text.
  static void implied(const auto&, const auto&) {}
  /// An enumerator, by its `name`, of `count`.
  void word(std::string_view name_of_member, auto value, std::size_t) {
    (*this)(name_of_member, std::string(name(value)));
  }
  void within(std::string_view name, int value, int, int) { (*this)(name, value); }
  /// A figure, or a text that says that the simulator did not report it.
  template <class Value>
  void reported(std::string_view name, const std::optional<Value>& value) {
    json[std::string(name)] = value ? Json(*value) : Json(kNotReported);
  }
  void object(std::string_view name, const auto& members) {
    FieldWriter inner;
    members(inner);
    json[std::string(name)] = std::move(inner.json);
  }
  /// By functions to JSON and back.
  void converted(std::string_view name, const auto& value, const auto& to_json, const auto&) {
    json[std::string(name)] = to_json(value);
  }

  template <class Value>
  static Json json_of(const Value& value) {
    if constexpr (Time<Value>) {
      return exact_seconds(value);
    } else if constexpr (kIsOptional<Value>) {
      return value ? json_of(*value) : Json(nullptr);
    } else if constexpr (kIsList<Value>) {
      Json array = Json::array();
      for (const auto& element : value) array.push_back(json_of(element));
      return array;
    } else if constexpr (std::is_constructible_v<Json, const Value&>) {
      return value;
    } else {
      FieldWriter io;
      fields(io, value);
      return std::move(io.json);
    }
  }
};

/// Every call throws Error(kBadFile) about the member if it is missing or of another type. A view:
/// document and file name must outlive it.
class FieldReader {
 public:
  FieldReader(const Json& object, const std::filesystem::path& file)
      : object_(&object), file_(&file) {
    require(object.is_object(), "", "must contain JSON objects");
  }

  void operator()(std::string_view name, auto& value) const { read(member(name), name, value); }
  bool has(std::string_view name, bool = true) const { return object_->contains(name); }
  template <class Value>
  static Value& value_of(std::optional<Value>& value) {
    return value ? *value : value.emplace();
  }
  template <class Value>
  void optional(std::string_view name, std::optional<Value>& value) const {
    if (has(name)) (*this)(name, value.emplace());
  }
  void some(std::string_view name, auto& value) const { since(name, value); }
  void since(std::string_view name, auto& value) const {
    if (has(name)) (*this)(name, value);
  }
  static void derived(std::string_view, const auto&) {}
  static void implied(auto& value, const auto& source) { value = source; }
  template <class Word>
  void word(std::string_view name_of_member, Word& value, std::size_t count) const {
    std::string text;
    (*this)(name_of_member, text);
    for (std::size_t i = 0; i < count; ++i) {
      value = static_cast<Word>(i);
      if (name(value) == text) return;
    }
    require(false, name_of_member, fmt::format("is \"{}\"", text));
  }
  void within(std::string_view name, int& value, int least, int most) const {
    (*this)(name, value);
    require(value >= least && value <= most, name, fmt::format("must be {} to {}", least, most));
  }
  template <class Value>
  void reported(std::string_view name, std::optional<Value>& value) const {
    value.reset();
    if (!member(name).is_string()) (*this)(name, value.emplace());
  }
  void object(std::string_view name, const auto& members) const {
    const FieldReader io(member(name), *file_);
    members(io);
  }
  void converted(std::string_view name, auto& value, const auto&, const auto& from_json) const {
    value = from_json(member(name));
  }
  void require_schema(int newest) const;

 private:
  template <class Value>
  void read(const Json& json, std::string_view name, Value& value) const {
    if constexpr (std::is_same_v<Value, std::string>) {
      require(json.is_string(), name, "must be a string");
      value = json.get<std::string>();
    } else if constexpr (std::is_same_v<Value, bool>) {
      require(json.is_boolean(), name, "must be true or false");
      value = json.get<bool>();
    } else if constexpr (std::is_floating_point_v<Value>) {
      require(json.is_number(), name, "must be a number");
      value = json.get<double>();
    } else if constexpr (std::is_integral_v<Value>) {
      require(json.is_number_unsigned(), name, "must be a non-negative integer");
      constexpr std::uint64_t kMost = std::numeric_limits<Value>::max();
      value = static_cast<Value>(std::min(json.get<std::uint64_t>(), kMost));
    } else if constexpr (Time<Value>) {
      double seconds = 0.0;
      read(json, name, seconds);
      if (!is_representable_seconds(seconds))
        require(false, name, fmt::format("is out of range ({})", seconds));
      value = Value(duration_from_seconds(seconds));
    } else if constexpr (kIsOptional<Value>) {
      value.reset();
      if (!json.is_null()) read(json, name, value.emplace());
    } else if constexpr (kIsList<Value>) {
      require(json.is_array(), name, "must be an array");
      value.clear();
      for (const Json& element : json) read(element, name, value.emplace_back());
    } else if constexpr (std::is_same_v<Value, std::map<std::string, std::string>>) {
      require(json.is_object(), name, "must be an object");
      for (const auto& [key, text] : json.items()) read(text, key, value[key]);
    } else {
      require(json.is_object(), name, "must be an object");
      const FieldReader io(json, *file_);
      fields(io, value);
    }
  }
  const Json& member(std::string_view name) const;
  void require(bool condition, std::string_view name, std::string_view problem) const;

  const Json* object_;
  const std::filesystem::path* file_;
};

/// A file: an object that begins with its schema.
std::string text_of(const auto& whole, int schema) {
  FieldWriter io;
  io("schema", schema);
  fields(io, whole);
  return io.json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}
template <class Whole>
Whole read_text(const std::string& text, const std::filesystem::path& file, int newest_schema) {
  const Json document = parse_json(text, file);
  const FieldReader io(document, file);
  io.require_schema(newest_schema);
  Whole whole;
  fields(io, whole);
  return whole;
}

}  // namespace tether::campaign
