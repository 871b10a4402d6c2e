#pragma once

#include "plots/inks.h"

#include <string>
#include <string_view>

/// Parts of drawings that no plot program makes: SVG on one line each.
namespace tether::report {

/// Attributes: the ink, also for viewers without CSS.
std::string fill_of(Ink ink);
std::string stroke_of(Ink ink);

std::string rectangle_svg(double x, double y, double width, double height, Ink ink);
/// @param anchor "start", "middle" or "end"
std::string text_svg(double x, double y, const std::string& words,
                     std::string_view anchor = "start", int size = 12);

}  // namespace tether::report
