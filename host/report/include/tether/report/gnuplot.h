#pragma once

#include <string>

#include <tether/report/plots.h>

namespace tether::report {

/// Draws a plot as SVG 1.1 with a style sheet for light and dark backgrounds, by the reader's
/// preference. Equal plots give equal files.
/// @param program looked for beside this program's file, then in PATH.
/// @throws Error(kSetup) if it is missing (subject: `program`), or fails to draw (subject: the
/// plot's title).
std::string draw_svg(const Plot& plot, const std::string& program = "gnuplot");

}  // namespace tether::report
