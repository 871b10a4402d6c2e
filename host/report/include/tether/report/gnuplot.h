#pragma once

#include <string>

#include <tether/report/plots.h>

namespace tether::report {

/// Draws a plot as SVG 1.1 with a style of its own: readable on light and dark ground, by the
/// reader's preference. Equal plots give equal files.
/// @param program found along PATH.
/// @throws Error(kSetup) when it is missing (with the package to install) or refuses the script.
std::string draw_svg(const Plot& plot, const std::string& program = "gnuplot");

}  // namespace tether::report
