#pragma once

#include <cstddef>
#include <string>

namespace tether::sim {

/// Limit of what a scene can hold: single-precision rendering and contacts fail long before.
inline constexpr double kMaxLength_m = 1e5;

/// What the numbers of an element must be, beyond finite.
struct ValueRule {
  bool (*holds)(double value);
  const char* allowed;    ///< in words, to end an error message with
  const char* unit = "";  ///< in words; empty where the numbers have none
  std::size_t count = 8;  ///< how many numbers it applies to, from the first on
};

/// The rule for the element `child` in `parent`; nullptr if any finite number is allowed.
const ValueRule* find_rule(const std::string& parent, const std::string& child);

}  // namespace tether::sim
