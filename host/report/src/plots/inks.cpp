#include "plots/inks.h"

#include <array>
#include <charconv>

#include <fmt/format.h>

namespace tether::report {
namespace {

struct Shades {
  std::string_view light, dark;
};

// The series are those of Okabe and Ito, which colour-blind people can distinguish, changed for
// enough contrast with either background.
constexpr std::array kShades = {
    Shades{"#1f2328", "#e6e8eb"},  // foreground
    Shades{"#c3c8ce", "#4a5058"},  // muted
    Shades{"#6b7280", "#9aa3af"},  // anchor
    Shades{"#0072b2", "#56b4e9"},  // blue
    Shades{"#d55e00", "#ff9a4d"},  // vermilion
    Shades{"#008a63", "#2ecfa0"},  // bluish green
    Shades{"#a8508a", "#e29cc6"},  // reddish purple
    Shades{"#8a6d00", "#f0e442"},  // yellow
    Shades{"#4d4d4d", "#bdbdbd"},  // grey
};
static_assert(kShades.size() == static_cast<std::size_t>(Ink::kSeries) + kSeriesInks);

constexpr std::string_view kMarkRed = "1", kMarkGreen = "2";

std::string_view next_number(std::string_view& text) {
  const auto begin = text.find_first_of("0123456789");
  if (begin == std::string_view::npos) return {};
  text.remove_prefix(begin);
  const std::string_view number = text.substr(0, text.find_first_not_of("0123456789"));
  text.remove_prefix(number.size());
  return number;
}

std::string rules(std::string_view Shades::*ground) {
  std::string css;
  for (std::size_t i = 0; i < kShades.size(); ++i) {
    for (const std::string_view property : {"stroke", "fill", "color"}) {
      css += fmt::format(".tp-{0}-{1}{{{0}:{2}}}", property, i, kShades[i].*ground);
    }
  }
  return css;
}

}  // namespace

Ink series_ink(std::size_t series) {
  return static_cast<Ink>(static_cast<std::size_t>(Ink::kSeries) + series % kSeriesInks);
}

std::string gnuplot_colour(Ink ink) {
  return fmt::format("rgb '#0102{:02x}'", static_cast<std::size_t>(ink));
}

std::optional<Ink> find_ink(std::string_view svg_colour) {
  if (!svg_colour.starts_with("rgb(")) return std::nullopt;
  if (next_number(svg_colour) != kMarkRed || next_number(svg_colour) != kMarkGreen)
    return std::nullopt;
  const std::string_view blue = next_number(svg_colour);
  std::size_t index = kShades.size();
  std::from_chars(blue.data(), blue.data() + blue.size(), index);
  if (index >= kShades.size()) return std::nullopt;
  return static_cast<Ink>(index);
}

std::string_view light_colour(Ink ink) {
  return kShades[static_cast<std::size_t>(ink)].light;
}

std::string ink_css() {
  return rules(&Shades::light) + "@media screen and (prefers-color-scheme:dark){" +
         rules(&Shades::dark) + "}";
}

}  // namespace tether::report
