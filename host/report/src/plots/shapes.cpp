#include "plots/shapes.h"

#include "plots/svg.h"

#include <algorithm>

#include <fmt/format.h>

namespace tether::report {

std::string fill_of(Ink ink) {
  return fmt::format("class=\"tp-fill-{}\" fill=\"{}\"", static_cast<std::size_t>(ink),
                     light_colour(ink));
}

std::string stroke_of(Ink ink) {
  return fmt::format("class=\"tp-stroke-{}\" stroke=\"{}\" fill=\"none\"",
                     static_cast<std::size_t>(ink), light_colour(ink));
}

std::string rectangle_svg(double x, double y, double width, double height, Ink ink) {
  return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" {}/>\n", x,
                     y, width, height, fill_of(ink));
}

std::string text_svg(double x, double y, const std::string& words, std::string_view anchor,
                     int size) {
  return fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\" {}>{}</text>\n", x, y,
      anchor, size, fill_of(Ink::kForeground), escape_markup(words));
}

}  // namespace tether::report
