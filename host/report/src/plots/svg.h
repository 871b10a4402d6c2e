#pragma once

#include <optional>
#include <string>
#include <string_view>

/// Changes to gnuplot's SVG. Pure functions.
namespace tether::report {

/// Text for XML or HTML: the five special characters escaped, control characters dropped.
std::string escape_markup(std::string_view text);

/// gnuplot's drawing on one line, with inks instead of colours, with the title, and without the
/// name of the drawing program. None if it is not a complete XML document.
std::optional<std::string> finished_svg(std::string_view drawn, const std::string& title);

/// A finished SVG for an HTML page that has `ink_css`: without prolog and style, and every id
/// begins with `prefix`.
std::string inline_svg(std::string_view finished, const std::string& prefix);

}  // namespace tether::report
