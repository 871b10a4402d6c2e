#include "heightmap.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <tether/base/text.h>

namespace tether::sim {
namespace {

constexpr int kMostHeights = 257;  // in each direction

}  // namespace

bool is_heightmap(const Geometry& geometry) {
  const auto* const mesh = std::get_if<MeshGeometry>(&geometry);
  if (mesh == nullptr || mesh->made) return false;
  const std::string type = lower_case(mesh->file.extension().string());
  return type == ".png" || type == ".jpg" || type == ".jpeg";
}

Heights heights_of(const raster::Mesh& mesh) {
  std::map<std::pair<float, float>, float> heights_m;  // by x, then y
  for (const raster::Mesh::Vertex& vertex : mesh.vertices)
    heights_m[{vertex.position[0], vertex.position[1]}] = vertex.position[2];
  Heights out;
  for (const auto& [at, height_m] : heights_m) {
    if (at.first == heights_m.begin()->first.first) ++out.rows;
    out.top_m = std::max(out.top_m, height_m);
  }
  if (out.rows == 0) return out;  // of no mesh that can be read
  out.columns = heights_m.size() / out.rows;
  out.shares.resize(heights_m.size());
  std::size_t i = 0;
  for (const auto& [at, height_m] : heights_m) {
    out.shares[i % out.rows * out.columns + i / out.rows] = height_m / out.top_m;
    ++i;
  }
  out.half_x_m = heights_m.rbegin()->first.first;
  out.half_y_m = heights_m.rbegin()->first.second;
  return out;
}

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
          fmt::format("f {0}/{0} {1}/{1} {3}/{3}\nf {1}/{1} {2}/{2} {3}/{3}\n", a, b, b + 1, a + 1);
    }
  return text;
}

}  // namespace tether::sim
