#include "json_reader.h"

#include <utility>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/base/json_depth.h>

namespace tether::campaign {

Json parse_json(const std::string& text, const std::filesystem::path& file) {
  if (json_depth(text) > kMaxJsonDepth) {
    throw Error(ErrorCode::kBadFile, {file.string()},
                fmt::format("is nested deeper than {} levels.", kMaxJsonDepth));
  }
  Json document = Json::parse(text, nullptr, false);
  if (document.is_discarded()) {
    throw Error(ErrorCode::kBadFile, {file.string()},
                "is truncated or corrupt: it is not a complete JSON document.");
  }
  return document;
}

JsonReader::JsonReader(const Json& object, std::filesystem::path file)
    : object_(&object), file_(std::move(file)) {
  if (!object.is_object()) fail("", "must contain JSON objects");
}

void JsonReader::fail(std::string_view key, const std::string& problem) const {
  throw Error(ErrorCode::kBadFile, {file_.string()},
              key.empty() ? problem : fmt::format("'{}' {}", key, problem))
      .about(std::string(key));
}

bool JsonReader::has(std::string_view key) const {
  return object_->contains(key);
}

const Json& JsonReader::member(std::string_view key) const {
  const auto found = object_->find(key);
  if (found == object_->end()) fail(key, "is missing");
  return *found;
}

const Json& JsonReader::member(std::string_view key, IsType is_type, std::string_view type) const {
  const Json& value = member(key);
  if (!(value.*is_type)()) fail(key, fmt::format("must be {}", type));
  return value;
}

std::string JsonReader::text(std::string_view key) const {
  return member(key, &Json::is_string, "a string").get<std::string>();
}

bool JsonReader::boolean(std::string_view key) const {
  return member(key, &Json::is_boolean, "true or false").get<bool>();
}

double JsonReader::number(std::string_view key) const {
  return member(key, &Json::is_number, "a number").get<double>();
}

std::uint64_t JsonReader::count(std::string_view key) const {
  return member(key, &Json::is_number_unsigned, "a non-negative integer").get<std::uint64_t>();
}

Duration JsonReader::seconds(std::string_view key) const {
  const double seconds = number(key);
  if (!is_representable_seconds(seconds)) fail(key, fmt::format("is out of range ({})", seconds));
  return duration_from_seconds(seconds);
}

JsonReader JsonReader::object(std::string_view key) const {
  return JsonReader(member(key, &Json::is_object, "an object"), file_);
}

std::vector<JsonReader> JsonReader::objects(std::string_view key) const {
  std::vector<JsonReader> objects;
  for (const Json& element : member(key, &Json::is_array, "an array")) {
    objects.emplace_back(element, file_);
  }
  return objects;
}

template <class T>
std::vector<T> JsonReader::elements(std::string_view key, IsType is_type,
                                    std::string_view type) const {
  std::vector<T> elements;
  for (const Json& element : member(key, &Json::is_array, type)) {
    if (!(element.*is_type)()) fail(key, fmt::format("must be {}", type));
    elements.push_back(element.get<T>());
  }
  return elements;
}

std::vector<std::string> JsonReader::texts(std::string_view key) const {
  return elements<std::string>(key, &Json::is_string, "an array of strings");
}

std::vector<std::uint64_t> JsonReader::counts(std::string_view key) const {
  return elements<std::uint64_t>(key, &Json::is_number_unsigned,
                                 "an array of non-negative integers");
}

std::vector<double> JsonReader::numbers(std::string_view key) const {
  return elements<double>(key, &Json::is_number, "an array of numbers");
}

std::map<std::string, std::string> JsonReader::all_texts() const {
  std::map<std::string, std::string> texts;
  for (const auto& [key, value] : object_->items()) texts.emplace(key, text(key));
  return texts;
}

void JsonReader::require_schema(int newest) const {
  const std::uint64_t schema = count("schema");
  if (schema >= 1 && schema <= static_cast<std::uint64_t>(newest)) return;
  fail("schema", fmt::format("is {}, but this version of Tether reads up to {}", schema, newest));
}

}  // namespace tether::campaign
