#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tether {

/// The UTF-8 text with '?' for each control character, so that it cannot break lines or control a
/// terminal, and without blanks at its ends.
std::string printable(const std::string& text);

/// "1 flight", "3 flights".
std::string counted(std::size_t count, std::string_view noun);

}  // namespace tether
