#include "json_fields.h"

#include "damage.h"

#include <limits>

#include <tether/base/json_depth.h>

namespace tether::record {
namespace {

[[noreturn]] void fail(const char* name, const char* what) {
  throw Damage("member \"" + std::string(name) + "\" " + what);
}

double to_number(const Json& value, const char* name) {
  if (value.is_null()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  if (!value.is_number()) {
    fail(name, "is no number");
  }
  return value.get<double>();
}

}  // namespace

Json parse_object(std::string_view text) {
  if (json_depth(text) > kMaxJsonDepth) {
    throw Damage("JSON nested too deeply");
  }
  Json parsed = Json::parse(text, nullptr, false);
  if (!parsed.is_object()) {
    throw Damage("not a JSON object");
  }
  return parsed;
}

const Json& member(const Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end()) {
    fail(name, "is missing");
  }
  return *found;
}

std::string text_member(const Json& object, const char* name) {
  const Json& value = member(object, name);
  if (!value.is_string()) {
    fail(name, "is no text");
  }
  return value.get<std::string>();
}

std::int64_t integer_member(const Json& object, const char* name) {
  const Json& value = member(object, name);
  constexpr auto kMax = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (!value.is_number_integer() ||
      (value.is_number_unsigned() && value.get<std::uint64_t>() > kMax)) {
    fail(name, "is no 64-bit integer");
  }
  return value.get<std::int64_t>();
}

std::uint64_t unsigned_member(const Json& object, const char* name) {
  const Json& value = member(object, name);
  if (!value.is_number_unsigned()) {
    fail(name, "is no unsigned integer");
  }
  return value.get<std::uint64_t>();
}

double number_member(const Json& object, const char* name) {
  return to_number(member(object, name), name);
}

bool boolean_member(const Json& object, const char* name) {
  const Json& value = member(object, name);
  if (!value.is_boolean()) {
    fail(name, "is neither true nor false");
  }
  return value.get<bool>();
}

void numbers_member(const Json& object, const char* name, std::span<double> out) {
  const Json& value = member(object, name);
  if (!value.is_array() || value.size() != out.size()) {
    fail(name, "is no list of the right length");
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = to_number(value[i], name);
  }
}

}  // namespace tether::record
