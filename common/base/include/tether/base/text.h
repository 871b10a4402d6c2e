#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Small texts and names.
namespace tether {

/// The UTF-8 text with '?' for each control character, so that it cannot break lines or control a
/// terminal, and without blanks at its ends.
std::string printable(const std::string& text);

/// "1 flight", "3 flights".
std::string counted(std::size_t count, std::string_view noun);

/// With small letters in place of A to Z, in any locale.
std::string lower_case(std::string_view text);

/// The text of which a URI has this: "Ground Plane" of "Ground%20Plane". What is no code stays.
std::string unescaped(std::string_view uri);

}  // namespace tether
