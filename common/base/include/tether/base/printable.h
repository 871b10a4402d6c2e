#pragma once

#include <string>

namespace tether {

/// The UTF-8 text with '?' for each control character, so that it cannot break lines or control a
/// terminal, and without blanks at its ends.
std::string printable(const std::string& text);

}  // namespace tether
