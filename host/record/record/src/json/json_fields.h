#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

/// Reading members of parsed JSON, with errors that name them. All throw `Damage`.
namespace tether::record {

using Json = nlohmann::ordered_json;

/// Parses one object.
Json parse_object(std::string_view text);

const Json& member(const Json& object, const char* name);
std::string text_member(const Json& object, const char* name);
/// From `least` to `most`.
std::int64_t integer_member(const Json& object, const char* name,
                            std::int64_t least = std::numeric_limits<std::int64_t>::min(),
                            std::int64_t most = std::numeric_limits<std::int64_t>::max());
std::uint64_t unsigned_member(const Json& object, const char* name);
/// `null` is read as NaN.
double number_member(const Json& object, const char* name);
bool boolean_member(const Json& object, const char* name);
/// Exactly as many numbers as `out` has places.
void numbers_member(const Json& object, const char* name, std::span<double> out);

}  // namespace tether::record
