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

/// A time axis at the bottom of lanes: ticks from ST 0 to `end_s`, lines upwards from them, and its
/// name. It takes 42 units below `bottom`.
std::string time_axis_svg(double left, double right, double top, double bottom, double end_s);

}  // namespace tether::report
