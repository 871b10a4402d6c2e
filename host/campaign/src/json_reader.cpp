#include "json_reader.h"

#include <utility>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/base/json_depth.h>

namespace tether::campaign {

Json parse_json(const std::string& text, const std::filesystem::path& file) {
  if (json_depth(text) > kMaxJsonDepth) {
    throw Error(ErrorCode::kBadFile, FileLocation{file.string()},
                fmt::format("is nested deeper than {} levels", kMaxJsonDepth));
  }
  Json document = Json::parse(text, nullptr, false);
  if (document.is_discarded()) {
    throw Error(ErrorCode::kBadFile, FileLocation{file.string()},
                "is torn or damaged: it is no whole JSON document");
  }
  return document;
}

JsonReader::JsonReader(const Json& object, std::filesystem::path file)
    : object_(&object), file_(std::move(file)) {
  if (!object.is_object()) fail("expected a JSON object");
}

void JsonReader::fail(const std::string& problem) const {
  throw Error(ErrorCode::kBadFile, FileLocation{file_.string()}, problem);
}

bool JsonReader::has(std::string_view key) const {
  return object_->contains(key);
}

const Json& JsonReader::member(std::string_view key) const {
  const auto found = object_->find(key);
  if (found == object_->end()) fail(fmt::format("lacks the member '{}'", key));
  return *found;
}

std::string JsonReader::text(std::string_view key) const {
  const Json& value = member(key);
  if (!value.is_string()) fail(fmt::format("'{}' must be a string", key));
  return value.get<std::string>();
}

bool JsonReader::boolean(std::string_view key) const {
  const Json& value = member(key);
  if (!value.is_boolean()) fail(fmt::format("'{}' must be true or false", key));
  return value.get<bool>();
}

double JsonReader::number(std::string_view key) const {
  const Json& value = member(key);
  if (!value.is_number()) fail(fmt::format("'{}' must be a number", key));
  return value.get<double>();
}

std::optional<double> JsonReader::optional_number(std::string_view key) const {
  if (member(key).is_null()) return std::nullopt;
  return number(key);
}

std::uint64_t JsonReader::count(std::string_view key) const {
  const Json& value = member(key);
  if (!value.is_number_unsigned()) fail(fmt::format("'{}' must be a whole number", key));
  return value.get<std::uint64_t>();
}

Duration JsonReader::seconds(std::string_view key) const {
  const double seconds = number(key);
  if (!is_representable_seconds(seconds)) fail(fmt::format("'{}' is out of range", key));
  return duration_from_seconds(seconds);
}

JsonReader JsonReader::object(std::string_view key) const {
  const Json& value = member(key);
  if (!value.is_object()) fail(fmt::format("'{}' must be an object", key));
  return JsonReader(value, file_);
}

const Json& JsonReader::array(std::string_view key) const {
  const Json& value = member(key);
  if (!value.is_array()) fail(fmt::format("'{}' must be an array", key));
  return value;
}

std::vector<JsonReader> JsonReader::objects(std::string_view key) const {
  std::vector<JsonReader> objects;
  for (const Json& element : array(key)) objects.emplace_back(element, file_);
  return objects;
}

std::vector<std::string> JsonReader::texts(std::string_view key) const {
  std::vector<std::string> texts;
  for (const Json& element : array(key)) {
    if (!element.is_string()) fail(fmt::format("'{}' must be an array of strings", key));
    texts.push_back(element.get<std::string>());
  }
  return texts;
}

std::vector<std::uint64_t> JsonReader::counts(std::string_view key) const {
  std::vector<std::uint64_t> counts;
  for (const Json& element : array(key)) {
    if (!element.is_number_unsigned()) fail(fmt::format("'{}' must be whole numbers", key));
    counts.push_back(element.get<std::uint64_t>());
  }
  return counts;
}

std::map<std::string, std::string> JsonReader::all_texts() const {
  std::map<std::string, std::string> texts;
  for (const auto& [key, value] : object_->items()) texts.emplace(key, text(key));
  return texts;
}

void JsonReader::require_schema(int newest) const {
  const std::uint64_t schema = count("schema");
  if (schema >= 1 && schema <= static_cast<std::uint64_t>(newest)) return;
  fail(fmt::format("has schema {}, but this version of Tether reads up to {}", schema, newest));
}

}  // namespace tether::campaign
