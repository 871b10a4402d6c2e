#pragma once

#include <cstddef>
#include <initializer_list>
#include <string_view>

namespace tether {

/// The name of an enumerator, from the names of all enumerators in order; "unknown" for a value
/// beyond them. @pre the enumerators are 0, 1, 2, …; `names` are literals.
template <class Enum>
constexpr std::string_view enum_name(Enum value, std::initializer_list<std::string_view> names) {
  const auto index = static_cast<std::size_t>(value);
  return index < names.size() ? names.begin()[index] : "unknown";
}

}  // namespace tether
