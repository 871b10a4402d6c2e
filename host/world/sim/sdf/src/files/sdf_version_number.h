#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <utility>

namespace tether::sim {

/// Major and minor: "1.9" is {1, 9}.
using SdfVersion = std::pair<int, int>;

/// None if the text is null or does not begin with a version.
inline std::optional<SdfVersion> parse_sdf_version(const char* text) {
  SdfVersion version;
  if (text == nullptr || std::sscanf(text, "%d.%d", &version.first, &version.second) != 2)
    return std::nullopt;
  return version;
}

inline std::string to_string(const SdfVersion& version) {
  return std::to_string(version.first) + "." + std::to_string(version.second);
}

}  // namespace tether::sim
