#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace tether::link {

/// The position of the first error [bytes]; none if `text` is one JSON object (RFC 8259) in UTF-8
/// with numbers that fit a double. Reads the text once, without recursion.
std::optional<std::size_t> fault_of_json_object(std::string_view text);

/// What a SUT's text breaks: it is one JSON object, nested no deeper than kMaxSutJsonDepth. Empty:
/// nothing.
std::string complaint_about_json(const std::string& text);

}  // namespace tether::link
