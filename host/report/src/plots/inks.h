#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

/// The colours of plots. A script names inks. In the SVG each ink becomes a CSS class with a colour
/// for light and one for dark backgrounds, so that one drawing serves both.
namespace tether::report {

enum class Ink : std::size_t {
  kForeground,
  kMuted,  ///< grids and references
  kAnchor,
  kSeries,  ///< the first of kSeriesInks
};
inline constexpr std::size_t kSeriesInks = 6;

/// The ink of a series. After kSeriesInks they repeat.
Ink series_ink(std::size_t series);

/// For a script: the colour that stands for the ink, "rgb '#010203'".
std::string gnuplot_colour(Ink ink);
/// The ink that a colour of gnuplot's SVG ("rgb(  1,   2,   3)") stands for; none: another colour.
std::optional<Ink> find_ink(std::string_view svg_colour);

/// The ink's colour on a light background, "#rrggbb": for viewers without CSS.
std::string_view light_colour(Ink ink);
/// The rules of the classes `tp-stroke-N`, `tp-fill-N` and `tp-color-N` of ink N.
std::string ink_css();

}  // namespace tether::report
