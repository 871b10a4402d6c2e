#pragma once

#include <compare>
#include <cstdio>
#include <optional>
#include <string>

namespace tether::sim {

/// "1.9"
struct SdfVersion {
  int major = 0;
  int minor = 0;
  friend auto operator<=>(const SdfVersion&, const SdfVersion&) = default;
};

/// None if the text is null or does not begin with a version.
inline std::optional<SdfVersion> parse_sdf_version(const char* text) {
  SdfVersion version;
  if (text == nullptr || std::sscanf(text, "%d.%d", &version.major, &version.minor) != 2)
    return std::nullopt;
  return version;
}

inline std::string to_string(const SdfVersion& version) {
  return std::to_string(version.major) + "." + std::to_string(version.minor);
}

}  // namespace tether::sim
