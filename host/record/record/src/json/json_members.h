#pragma once

#include "damage.h"
#include "json/json_fields.h"
#include "json/json_text.h"
#include "json/members.h"

#include <optional>
#include <string>
#include <type_traits>

/// The two directions of `members` for JSON objects.
namespace tether::record {

/// Which members of a message to write; `schemas.cpp` describes the whole.
struct JsonParts {
  bool wall = true;      ///< host clock readings, under "wall"
  bool arrivals = true;  ///< ST at arrival and the lag
};

template <class Value>
concept Time = requires(const Value& value) {
  to_ns(value);
};

template <class Message>
void append_members(std::string& out, const Message& message, JsonParts parts = {});
template <class Message>
Message read_members(const Json& json);

/// Writes a JSON object, member by member.
class MemberWriter {
 public:
  explicit MemberWriter(std::string& out, JsonParts parts = {}) : object_(out), parts_(parts) {}

  bool wall() const { return parts_.wall; }
  bool arrivals() const { return parts_.arrivals; }
  bool has(const char*, bool condition) const { return condition; }
  template <class Value>
  static const Value& value_of(const std::optional<Value>& value) {
    return *value;
  }

  template <class Value>
  void operator()(const char* name, const Value& value) {
    if constexpr (std::is_same_v<Value, bool>) {
      object_.boolean(name, value);
    } else if constexpr (std::integral<Value>) {
      object_.integer(name, value);
    } else if constexpr (std::is_same_v<Value, double>) {
      object_.number(name, value);
    } else if constexpr (std::is_same_v<Value, computer::ClockKind>) {
      object_.text(name, computer::name(value));
    } else if constexpr (std::is_array_v<Value> || std::is_same_v<Value, std::vector<double>>) {
      object_.numbers(name, value);
    } else if constexpr (Time<Value>) {
      object_.integer(name, to_ns(value));
    } else {
      object_.text(name, value);
    }
  }
  void within(const char* name, int value, int, int) { (*this)(name, value); }
  void positive(const char* name, double value) { (*this)(name, value); }
  template <class Value>
  void optional(const char* name, const std::optional<Value>& value) {
    if (value) (*this)(name, *value);
  }
  void flag(const char* name, bool value) {
    if (value) (*this)(name, value);
  }
  template <class Value>
  void look_ahead(const char*, const Value&) {}
  template <class Fields>
  void object(const char* name, Fields fields) {
    MemberWriter inner(object_.begin(name));
    fields(inner);
    inner.close();
  }
  /// Of objects or texts.
  template <class Item>
  void list(const char* name, const std::vector<Item>& items) {
    std::string& out = object_.begin(name);
    out += '[';
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (i > 0) out += ',';
      if constexpr (std::is_same_v<Item, std::string>) {
        append_json_string(out, items[i]);
      } else {
        append_members(out, items[i]);
      }
    }
    out += ']';
  }
  /// To append members of another kind.
  JsonObject& json() { return object_; }
  void close() { object_.close(); }

 private:
  JsonObject object_;
  JsonParts parts_;
};

/// Reads them. @throws Damage naming the member that is missing or wrong.
class MemberReader {
 public:
  explicit MemberReader(const Json& object) : object_(object) {}

  static constexpr bool wall() { return true; }
  static constexpr bool arrivals() { return true; }
  bool has(const char* name, bool) const { return object_.contains(name); }
  template <class Value>
  static Value& value_of(std::optional<Value>& value) {
    return value.emplace();
  }

  void operator()(const char* name, std::string& value) const {
    value = text_member(object_, name);
  }
  void operator()(const char* name, bool& value) const { value = boolean_member(object_, name); }
  void operator()(const char* name, double& value) const { value = number_member(object_, name); }
  void operator()(const char* name, std::uint64_t& value) const {
    value = unsigned_member(object_, name);
  }
  void operator()(const char* name, computer::ClockKind& kind) const {
    const auto named = computer::clock_kind(text_member(object_, name));
    if (!named) throw Damage("member", name, "is not the name of a clock");
    kind = *named;
  }
  template <Time Value>
  void operator()(const char* name, Value& value) const {
    value = Value(Duration(integer_member(object_, name)));
  }
  template <std::size_t Count>
  void operator()(const char* name, double (&values)[Count]) const {
    numbers_member(object_, name, values);
  }
  void operator()(const char* name, std::vector<double>& values) const {
    constexpr std::size_t kMost = 64;
    const Json& array = member(object_, name);
    if (!array.is_array() || array.size() > kMost)
      throw Damage("member", name, "is not a list of at most 64 numbers");
    values.resize(array.size());
    numbers_member(object_, name, values);
  }
  void within(const char* name, int& value, int least, int most) const {
    value = static_cast<int>(integer_member(object_, name, least, most));
  }
  void positive(const char* name, double& value) const {
    value = number_member(object_, name);
    if (!(value > 0.0)) throw Damage("member", name, "is not positive");
  }
  template <class Value>
  void optional(const char* name, std::optional<Value>& value) const {
    value.reset();
    if (object_.contains(name)) (*this)(name, value.emplace());
  }
  void flag(const char* name, bool& value) const {
    value = object_.contains(name) && boolean_member(object_, name);
  }
  void look_ahead(const char* name, bool& value) const { flag(name, value); }
  template <class Value>
  void look_ahead(const char* name, std::optional<Value>& value) const {
    optional(name, value);
  }
  template <class Fields>
  void object(const char* name, Fields fields) const {
    const MemberReader inner(member(object_, name));
    fields(inner);
  }
  template <class Item>
  void list(const char* name, std::vector<Item>& items) const {
    const Json& array = member(object_, name);
    if (!array.is_array()) throw Damage("member", name, "is not a list");
    for (const Json& item : array) {
      if constexpr (std::is_same_v<Item, std::string>) {
        if (!item.is_string()) throw Damage("member", name, "is not a list of strings");
        items.push_back(item.get<std::string>());
      } else {
        items.push_back(read_members<Item>(item));
      }
    }
  }

 private:
  const Json& object_;
};

template <class Message>
void append_members(std::string& out, const Message& message, JsonParts parts) {
  MemberWriter writer(out, parts);
  members(writer, message);
  writer.close();
}

template <class Message>
Message read_members(const Json& json) {
  Message message;
  const MemberReader reader(json);
  members(reader, message);
  return message;
}

}  // namespace tether::record
