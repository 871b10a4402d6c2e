#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include <tether/base/time.h>

/// Reading members of parsed JSON, with errors that name them. All throw `Damage`.
namespace tether::record {

using Json = nlohmann::ordered_json;

/// Parses one object.
Json parse_object(std::string_view text);

const Json& member(const Json& object, const char* name);
std::string text_member(const Json& object, const char* name);
std::int64_t integer_member(const Json& object, const char* name);
std::uint64_t unsigned_member(const Json& object, const char* name);
double number_member(const Json& object, const char* name);
bool boolean_member(const Json& object, const char* name);
/// Exactly as many numbers as `out` has places.
void numbers_member(const Json& object, const char* name, std::span<double> out);

/// A time point or duration in nanoseconds.
template <class Time>
Time time_member(const Json& object, const char* name) {
  return Time(Duration(integer_member(object, name)));
}
template <class Time>
std::optional<Time> optional_time_member(const Json& object, const char* name) {
  if (!object.contains(name)) {
    return std::nullopt;
  }
  return time_member<Time>(object, name);
}

}  // namespace tether::record
