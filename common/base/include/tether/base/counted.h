#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tether {

/// "1 flight", "3 flights".
inline std::string counted(std::size_t count, std::string_view noun) {
  return std::to_string(count) + " " + std::string(noun) + (count == 1 ? "" : "s");
}

}  // namespace tether
