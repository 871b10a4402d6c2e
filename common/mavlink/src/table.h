#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace tether::mavlink {

struct Row {
  std::uint32_t id;
  std::string_view name;
  std::string_view fields;
};

/// In the order of ids.
std::span<const Row> rows();

}  // namespace tether::mavlink
