#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace tether::link {

/// None if `text` is one JSON object (RFC 8259) in UTF-8, with numbers that a double can hold; else
/// about how many bytes of it are. Reads it once, without recursion.
std::optional<std::size_t> fault_of_json_object(std::string_view text);

}  // namespace tether::link
