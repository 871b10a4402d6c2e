#include "pictures/captioned_picture.h"

#include "plots/svg.h"

#include <fmt/format.h>

namespace tether::report {

std::string to_svg(const CaptionedPicture& picture) {
  constexpr unsigned kLine_px = 22;
  const auto lines = static_cast<unsigned>(picture.lines.size());
  const std::string what = escape_markup(picture.what);
  std::string svg = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" role="img" aria-label="{4}, {5}" width="{0}" height="{1}" viewBox="0 0 {0} {1}" font-family="sans-serif">)"
      "\n"
      R"(<rect width="{0}" height="{1}" fill="#1b1b1b"/><image width="{0}" height="{2}" href="{3}"/>)"
      "\n",
      picture.width_px, picture.height_px + 10 + kLine_px * (lines + 1), picture.height_px,
      picture.data_uri, picture.kind, what);
  svg += picture.drawings;
  unsigned y_px = picture.height_px + kLine_px;
  svg += fmt::format(R"(<text x="10" y="{}" font-size="14" fill="#f2f2f2">{}</text>)"
                     "\n",
                     y_px, what);
  for (const CaptionedPicture::Line& line : picture.lines) {
    y_px += kLine_px;
    svg += fmt::format(
        R"-(<g transform="translate(0 {})">{}<text x="42" font-size="14" fill="#f2f2f2">{}</text></g>)-"
        "\n",
        y_px, line.symbol, escape_markup(line.text));
  }
  return svg + "</svg>\n";
}

}  // namespace tether::report
