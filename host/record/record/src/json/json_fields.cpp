#include "json/json_fields.h"

#include "damage.h"

#include <tether/base/text.h>

namespace tether::record {
namespace {

[[noreturn]] void fail(const char* name, const std::string& what) {
  throw Damage("member", name, what);
}

double to_number(const Json& value, const char* name) {
  if (value.is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (!value.is_number()) fail(name, "is not a number");
  return value.get<double>();
}

}  // namespace

Json parse_object(std::string_view text) {
  if (json_depth(text) > kMaxJsonDepth) throw Damage("JSON nested too deeply");
  Json parsed = Json::parse(text, nullptr, false);
  if (!parsed.is_object()) throw Damage("not a JSON object");
  return parsed;
}

const Json& member(const Json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end()) fail(name, "is missing");
  return *found;
}

std::string text_member(const Json& object, const char* name) {
  const Json& value = member(object, name);
  if (!value.is_string()) fail(name, "is not a string");
  return value.get<std::string>();
}

std::int64_t integer_member(const Json& object, const char* name, std::int64_t least,
                            std::int64_t most) {
  const Json& value = member(object, name);
  constexpr auto kMax = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (!value.is_number_integer() ||
      (value.is_number_unsigned() && value.get<std::uint64_t>() > kMax))
    fail(name, "is not a 64-bit integer");
  const auto number = value.get<std::int64_t>();
  if (number < least || number > most)
    fail(name, "is " + std::to_string(number) + ". It must be from " + std::to_string(least) +
                   " to " + std::to_string(most));
  return number;
}

std::uint64_t unsigned_member(const Json& object, const char* name) {
  const Json& value = member(object, name);
  if (!value.is_number_unsigned()) fail(name, "is not an unsigned integer");
  return value.get<std::uint64_t>();
}

double number_member(const Json& object, const char* name) {
  return to_number(member(object, name), name);
}

bool boolean_member(const Json& object, const char* name) {
  const Json& value = member(object, name);
  if (!value.is_boolean()) fail(name, "is neither true nor false");
  return value.get<bool>();
}

void numbers_member(const Json& object, const char* name, std::span<double> out) {
  const Json& value = member(object, name);
  if (!value.is_array() || value.size() != out.size())
    fail(name, "is not a list of " + std::to_string(out.size()) + " numbers");
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = to_number(value[i], name);
}

}  // namespace tether::record
