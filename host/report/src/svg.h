#pragma once

#include <optional>
#include <string>
#include <string_view>

/// What is done to gnuplot's SVG. Pure functions.
namespace tether::report {

/// Text as XML or HTML shows it: the five special characters escaped, control characters dropped.
std::string escape_markup(std::string_view text);

/// gnuplot's drawing with inks for colours, its title and no trace of the program that drew it, on
/// one line. None if it is no whole XML document.
std::optional<std::string> finished_svg(std::string_view drawn, const std::string& title);

/// A finished SVG to stand inside an HTML page that has `ink_css`: no prolog, no style, and every
/// id begins with `prefix`.
std::string inline_svg(std::string_view finished, const std::string& prefix);

}  // namespace tether::report
