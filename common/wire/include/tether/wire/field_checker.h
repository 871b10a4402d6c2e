#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <tether/base/result.h>
#include <tether/wire/values.h>

namespace tether::wire {

/// Checks the fields of a message, and keeps the first complaint. Numbers are finite, times are not
/// negative, texts have no NUL; the rest is said beside each field. Not thread-safe.
class FieldChecker {
 public:
  template <class Where>
  void here(const Where& where) {
    where_ = said(where);
  }
  template <class Holds, class Text>
  void require(const Holds& holds, std::string_view field, const Text& rule) {
    if (!complaint_.empty() || said(holds)) return;
    complaint_ = where_ + std::string(field) + " " + std::string(said(rule));
  }

  template <class T, class... Options>
  void operator()(const char* name, const T& value, const Options&... options) {
    if (!complaint_.empty()) return;
    check(name, value, options...);
    (apply(name, value, options), ...);
  }

  Status status() const {
    if (complaint_.empty()) return ok_status();
    return Failure{Failure::Kind::kInvalid, complaint_};
  }

 private:
  /// A struct's parts, with its own name.
  struct Parts {
    FieldChecker& checker;
    const char* name;

    template <class T, class... Options>
    void operator()(const char*, const T& value, const Options&... options) {
      checker(name, value, options...);
    }
    template <class Holds, class Text>
    void require(const Holds& holds, const char*, const Text& rule) {
      checker.require(holds, name, rule);
    }
  };

  template <class Value, class... Arguments>
  static decltype(auto) said(const Value& value, const Arguments&... arguments) {
    if constexpr (requires { value(arguments...); }) {
      return value(arguments...);
    } else {
      return (value);
    }
  }

  template <class... Options>
  void check(const char* name, double value, const Options&...) {
    if constexpr (!kHas<AnyNumber, Options...>)
      require(std::isfinite(value), name, "is not a finite number");
  }
  template <Scalar T, class... Options>
  void check(const char* name, const T& value, const Options&...) {
    if constexpr (kIsTime<T>) {
      const std::int64_t ns = to_number(value);
      require(ns >= 0 && ns < kMaxTimestampNs, name, "is negative or beyond 146 years");
    }
  }
  template <class... Options>
  void check(const char* name, const std::string& text, const Options&...) {
    require(text.find('\0') == std::string::npos, name, "contains a NUL byte");
  }
  template <class T, class... Options>
  void check(const char* name, const std::vector<T>& items, const Options&... options) {
    // Bytes and pixels may be any.
    if constexpr (Scalar<T> && !std::is_same_v<T, double>) return;
    for (const T& item : items) {
      if (!complaint_.empty()) return;
      if constexpr (std::is_same_v<T, std::string>) {
        check(name, item);
        (apply_to_text(name, item, options), ...);
      } else {
        check(name, item, options...);
      }
    }
  }
  template <HasFields T, class... Options>
  void check(const char* name, const T& value, const Options&...) {
    if constexpr (Struct<T>) {
      Parts parts{*this, name};
      fields(parts, value);
    } else {
      const std::string outside = where_;
      fields(*this, value);
      if (complaint_.empty()) where_ = outside;
    }
  }
  template <class... Tables, class... Options>
  void check(const char* name, const std::variant<Tables...>& value, const Options&...) {
    std::visit([&](const auto& table) { check(name, table); }, value);
  }
  template <class T, class... Options>
  void check(const char* name, const std::optional<T>& value, const Options&...) {
    if (value) check(name, *value);
  }

  template <class T, class Option>
  void apply(const char*, const T&, const Option&) {}
  template <class T>
  void apply(const char* name, const std::vector<T>& items, const AtMost& limit) {
    require(items.size() <= limit.count, name, limit.complaint);
  }
  template <class Option>
  void apply_to_text(const char* name, const std::string& text, const Option& option) {
    if constexpr (std::is_same_v<Option, EachAtMost>) apply(name, text, AtMost{option.bytes});
  }
  void apply(const char* name, const std::string& text, const AtMost& limit) {
    require(text.size() <= limit.count, name,
            [&] { return "is longer than " + std::to_string(limit.count) + " bytes"; });
  }
  template <class T, class Holds, class Text>
  void apply(const char* name, const T& value, const Rule<Holds, Text>& rule) {
    require([&] { return rule.holds(value); }, name,
            [&] { return std::string(said(rule.text, value)); });
  }

  std::string where_;
  std::string complaint_;
};

}  // namespace tether::wire
