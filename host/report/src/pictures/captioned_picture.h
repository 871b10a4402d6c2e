#pragma once

#include <string>
#include <vector>

namespace tether::report {

/// A picture with drawings over it and a caption below.
struct CaptionedPicture {
  unsigned width_px = 0;
  unsigned height_px = 0;
  std::string data_uri;
  std::string kind;      ///< "Camera image"
  std::string what;      ///< where it is from; the caption's first line
  std::string drawings;  ///< SVG over the picture
  struct Line {
    std::string symbol;  ///< SVG from (10, -10) to (34, 0)
    std::string text;
  };
  std::vector<Line> lines{};
};

/// One self-contained SVG.
std::string to_svg(const CaptionedPicture& picture);

}  // namespace tether::report
