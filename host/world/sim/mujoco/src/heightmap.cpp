#include "heightmap.h"

#include <algorithm>

#include <fmt/format.h>

namespace tether::sim {
namespace {

constexpr int kMostHeights = 257;  // in each direction

}  // namespace

std::string obj_of_heights(const raster::Texture& picture) {
  const int columns = std::clamp(picture.width_px, 2, kMostHeights);
  const int rows = std::clamp(picture.height_px, 2, kMostHeights);
  const auto at = [](int i, int count, int pixels) { return i * (pixels - 1) / (count - 1); };
  int brightest = 1;
  const auto pixel = [&](int column, int row) {
    const auto x = static_cast<std::size_t>(at(column, columns, picture.width_px));
    const auto y = static_cast<std::size_t>(at(row, rows, picture.height_px));
    return int{picture.rgba[4 * (y * static_cast<std::size_t>(picture.width_px) + x)]};
  };
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
    brightest = std::max(brightest, int{picture.rgba[i]});
  std::string text;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double u = static_cast<double>(column) / (columns - 1);
      const double v = static_cast<double>(row) / (rows - 1);
      text += fmt::format("v {:.6f} {:.6f} {:.6f}\nvt {:.6f} {:.6f}\n", u - 0.5, 0.5 - v,
                          static_cast<double>(pixel(column, row)) / brightest, u, 1.0 - v);
    }
  for (int row = 0; row + 1 < rows; ++row)
    for (int column = 0; column + 1 < columns; ++column) {
      const int a = row * columns + column + 1;
      const int b = a + columns;
      text +=
          fmt::format("f {0}/{0} {1}/{1} {2}/{2}\nf {0}/{0} {2}/{2} {3}/{3}\n", a, b, b + 1, a + 1);
    }
  return text;
}

}  // namespace tether::sim
