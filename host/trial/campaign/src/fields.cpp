#include "fields.h"

#include <tether/base/error.h>
#include <tether/base/text.h>

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

void FieldReader::require(bool condition, std::string_view name, std::string_view problem) const {
  if (condition) return;
  throw Error(ErrorCode::kBadFile, {file_->string()},
              name.empty() ? std::string(problem) : fmt::format("'{}' {}", name, problem))
      .about(std::string(name));
}

const Json& FieldReader::member(std::string_view name) const {
  const auto found = object_->find(name);
  require(found != object_->end(), name, "is missing");
  return *found;
}

void FieldReader::require_schema(int newest) const {
  std::uint64_t schema = 0;
  (*this)("schema", schema);
  require(schema >= 1 && schema <= static_cast<std::uint64_t>(newest), "schema",
          fmt::format("is {}, but this version of Tether reads up to {}", schema, newest));
}

}  // namespace tether::campaign
