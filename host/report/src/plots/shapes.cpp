#include "plots/shapes.h"

#include "plots/svg.h"

#include <algorithm>
#include <cmath>

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

std::string time_axis_svg(double left, double right, double top, double bottom, double end_s) {
  end_s = std::max(end_s, 1e-9);
  // Ticks are 1, 2 or 5 times a power of ten apart, at most ten of them.
  const double power = std::pow(10.0, std::floor(std::log10(end_s / 10.0)));
  double step_s = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0})
    if (end_s / (factor * power) <= 10.0) step_s = factor * power;
  std::string svg;
  for (double s = 0.0; s <= end_s; s += step_s) {
    const double tick = left + (right - left) * s / end_s;
    svg += rectangle_svg(tick, top, 0.5, bottom - top, Ink::kMuted);
    svg += text_svg(tick, bottom + 16.0, fmt::format("{:g}", s), "middle");
  }
  return svg + text_svg((left + right) / 2.0, bottom + 34.0, "ST (s)", "middle");
}

}  // namespace tether::report
