#include "json/json_metadata.h"

#include "damage.h"
#include "json/json_fields.h"
#include "json/json_members.h"
#include "json/json_text.h"
#include "json/members.h"

#include <charconv>
#include <concepts>

#include <tether/base/text.h>

// Header and footer as MCAP metadata, a map of texts. Their members are listed once, in members.h:
// MetadataWriter and MetadataReader put each into the map or take it out. Lists (SUTs, sensors,
// anchors) are JSON arrays in one text. What the target reported of itself has a prefix.
namespace tether::record {
namespace {

constexpr const char* kTrue = "true";

class MetadataWriter {
 public:
  explicit MetadataWriter(StringMap& values) : values_(values) {}

  bool has(const char*, bool condition) const { return condition; }
  template <class Value>
  void operator()(const char* name, const Value& value) {
    std::string& text = values_[name];
    if constexpr (std::integral<Value>) {
      append_json_integer(text, value);
    } else if constexpr (std::is_same_v<Value, double>) {
      append_json_number(text, value);
    } else if constexpr (Time<Value>) {
      append_json_integer(text, to_ns(value));
    } else {
      text = to_utf8(value);
    }
  }
  void flag(const char* name, bool value) {
    if (value) values_[name] = kTrue;
  }
  template <class Item>
  void list(const char* name, const std::vector<Item>& items) {
    std::string& text = values_[name] = "[";
    for (const Item& item : items) {
      text += text.size() > 1 ? "," : "";
      if constexpr (Time<Item>) {
        append_json_integer(text, to_ns(item));
      } else if constexpr (std::is_same_v<Item, std::string>) {
        append_json_string(text, item);
      } else {
        append_members(text, item);
      }
    }
    text += "]";
  }

 private:
  StringMap& values_;
};

class MetadataReader {
 public:
  explicit MetadataReader(const StringMap& values) : values_(values) {}

  bool has(const char* name, bool) const { return values_.contains(name); }
  template <class Value>
  void operator()(const char* name, Value& value) const {
    if constexpr (std::integral<Value> || std::is_same_v<Value, double>) {
      value = number<Value>(name);
    } else if constexpr (Time<Value>) {
      value = Value(Duration(number<std::int64_t>(name)));
    } else {
      value = text(name);
    }
  }
  void flag(const char* name, bool& value) const {
    value = values_.contains(name);
    if (value && text(name) != kTrue) fail(name, "is not \"true\"");
  }
  template <class Item>
  void list(const char* name, std::vector<Item>& items) const {
    const std::string& array = text(name);
    const Json json =
        json_depth(array) > kMaxJsonDepth ? Json() : Json::parse(array, nullptr, false);
    if (!json.is_array()) fail(name, "is not a JSON array");
    for (const Json& element : json) {
      if constexpr (Time<Item>) {
        if (!element.is_number_integer()) fail(name, "has an element that is not an integer");
        items.push_back(from_ns<Item>(element.get<std::int64_t>()));
      } else if constexpr (std::is_same_v<Item, std::string>) {
        if (!element.is_string()) fail(name, "has an element that is not a string");
        items.push_back(element.get<std::string>());
      } else {
        items.push_back(read_members<Item>(element));
      }
    }
  }

  const std::string& text(const char* name) const {
    const auto found = values_.find(name);
    if (found == values_.end()) fail(name, "is missing");
    return found->second;
  }

 private:
  [[noreturn]] static void fail(const char* name, const char* what) {
    throw Damage("value", name, what);
  }

  template <class Number>
  Number number(const char* name) const {
    const std::string& digits = text(name);
    Number parsed{};
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), parsed);
    if (error != std::errc() || end != digits.data() + digits.size())
      fail(name, "is not a number in range");
    return parsed;
  }

  const StringMap& values_;
};

constexpr std::string_view kReading = "target/";

void add_readings(StringMap& values, const Readings& readings) {
  for (const auto& [name, reading] : readings)
    values[std::string(kReading) + to_utf8(name)] = to_utf8(reading);
}

Readings readings(const StringMap& values) {
  Readings readings;
  for (const auto& [name, reading] : values) {
    if (name.starts_with(kReading)) readings[name.substr(kReading.size())] = reading;
  }
  return readings;
}

}  // namespace

std::string to_text(const RadioInfo& radio) {
  StringMap values;
  MetadataWriter writer(values);
  if (!radio.model.empty()) radio_members(writer, radio);
  std::string text;
  for (const auto& [name, value] : values) text += (text.empty() ? "" : " ") + name + "=" + value;
  return text;
}

StringMap to_metadata(const Header& header) {
  StringMap values;
  MetadataWriter writer(values);
  members(writer, header);
  if (header.target) {
    writer("target_name", header.target->name);
    writer("target_address", header.target->address);
    add_readings(values, header.target->before);
  }
  return values;
}

int schema_version(const StringMap& values) {
  int version = 0;
  MetadataReader{values}("schema_version", version);
  return version;
}

Header header_from_metadata(const StringMap& values) {
  Header header;
  const MetadataReader reader(values);
  members(reader, header);
  if (values.contains("target_name"))
    header.target = {reader.text("target_name"), reader.text("target_address"), readings(values)};
  return header;
}

StringMap to_metadata(const Footer& footer) {
  StringMap values;
  MetadataWriter writer(values);
  members(writer, footer);
  add_readings(values, footer.target_after);
  return values;
}

Footer footer_from_metadata(const StringMap& values) {
  Footer footer;
  const MetadataReader reader(values);
  members(reader, footer);
  footer.target_after = readings(values);
  return footer;
}

}  // namespace tether::record
