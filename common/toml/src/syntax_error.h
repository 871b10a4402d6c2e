#pragma once

#include <string>
#include <string_view>

namespace tether::toml {

/// What is wrong with a line that the TOML library refused, and what to write instead, in place of
/// the library's own words, which name its grammar. `line` is the text of that line.
std::string syntax_error(std::string_view line, std::string_view parser);

/// Why a text cannot be TOML because of its encoding; empty: it can.
std::string wrong_encoding(std::string_view text);

/// The text of a line, counted from 1; empty if there is none.
std::string_view line_of_text(std::string_view text, int number);

}  // namespace tether::toml
