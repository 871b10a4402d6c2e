#include "exposure.h"

#include <algorithm>
#include <cmath>

namespace tether::raster {
namespace {

using uav::Vec3;

// A motion of this much changes the sharpest edge from black to white by half a grey level.
constexpr double kStill_px = 1.0 / 512.0;
constexpr int kMaxLayers = 27;
constexpr int kMinBandRows = 4;
constexpr double kBand_px = 0.5;

Vec3 most(const Vec3& a, const Vec3& b) {
  return {std::max(a.x, std::abs(b.x)), std::max(a.y, std::abs(b.y)), std::max(a.z, std::abs(b.z))};
}

// The most that a camera moves along and turns about each of its axes from an instant to the next.
struct CameraMotion {
  Vec3 shift_m, turn_rad;

  explicit CameraMotion(const View& view) {
    for (std::size_t i = 0; i + 1 < view.instants.size(); ++i) {
      const uav::Pose X = inverse(view.instants[i].X_WC) * view.instants[i + 1].X_WC;
      shift_m = most(shift_m, X.p);
      turn_rad = most(turn_rad, 2.0 * Vec3{X.q.x, X.q.y, X.q.z});
    }
  }

  // How far things at rest move in the picture where rays have slopes up to `x` and `y` and things
  // are no nearer than 1/inverse_depth.
  double px(const uav::CameraModel& camera, double x, double y, double inverse_depth) const {
    const double along_x = (shift_m.x + x * shift_m.z) * inverse_depth + turn_rad.x * x * y +
                           turn_rad.y * (1.0 + x * x) + turn_rad.z * y;
    const double along_y = (shift_m.y + y * shift_m.z) * inverse_depth + turn_rad.y * x * y +
                           turn_rad.x * (1.0 + y * y) + turn_rad.z * x;
    return std::hypot(camera.fx_px * along_x, camera.fy_px * along_y);
  }
};

// The pixels in which a sphere in C may be seen.
PixelRect pixels_of(const Vec3& p, double radius_m, const View& view, const Lens& lens) {
  const uav::CameraModel& c = view.camera;
  if (p.z + radius_m < view.near_m) return PixelRect::none();
  if (p.z - radius_m < view.near_m) return {0, 0, c.width_px - 1, c.height_px - 1};
  const auto at = [&](double beside_m, double f, double centre, auto choose) {
    const double slope = choose(beside_m / (p.z - radius_m), beside_m / (p.z + radius_m));
    const double px = std::clamp(centre + f * slope, -32000.0, 32000.0);
    return static_cast<std::int32_t>(px * kSubpixels);
  };
  const auto low = [](double a, double b) { return std::min(a, b); };
  const auto high = [](double a, double b) { return std::max(a, b); };
  return lens.pixels_of(
      {at(p.x - radius_m, c.fx_px, c.cx_px, low), at(p.y - radius_m, c.fy_px, c.cy_px, low),
       at(p.x + radius_m, c.fx_px, c.cx_px, high), at(p.y + radius_m, c.fy_px, c.cy_px, high)});
}

// Numbers of a picture's tiles.
struct TileGrid {
  int width_px, height_px;
  int across, down;

  explicit TileGrid(const uav::CameraModel& camera)
      : width_px(camera.width_px),
        height_px(camera.height_px),
        across(tiles_in(width_px)),
        down(tiles_in(height_px)) {}

  std::size_t size() const { return place(0, down); }
  std::size_t place(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(across) +
           static_cast<std::size_t>(column);
  }
  PixelRect pixels(int column, int row) const {
    const int x = column * kTile_px;
    const int y = row * kTile_px;
    return {x, y, std::min(width_px, x + kTile_px) - 1, std::min(height_px, y + kTile_px) - 1};
  }
  // Calls `use` for the tiles with these pixels, and for those within a tile of them: so far may
  // things move into a tile.
  template <class Use>
  void for_each_near(const PixelRect& pixels, const Use& use) const {
    const int last_row = std::min(down - 1, pixels.y_high / kTile_px + 1);
    const int last_column = std::min(across - 1, pixels.x_high / kTile_px + 1);
    for (int row = std::max(0, pixels.y_low / kTile_px - 1); row <= last_row; ++row) {
      for (int column = std::max(0, pixels.x_low / kTile_px - 1); column <= last_column; ++column) {
        use(place(column, row));
      }
    }
  }
};

// The 1/depth of the nearest that may be seen in or beside each tile [1/m].
std::vector<float> nearest_by_tile(const TileGrid& grid, const Lens& lens, const Layer& layer) {
  std::vector<float> nearest(grid.size(), 0.0F);
  for (int row = 0; row < grid.down; ++row) {
    for (int column = 0; column < grid.across; ++column) {
      const PixelRect tile = grid.pixels(column, row);
      const std::size_t i = grid.place(column, row);
      float own = 0.0F;
      for (const auto* const list : {&layer.opaque[i], &layer.transparent[i]}) {
        for (const std::uint32_t triangle : *list) {
          const Coverage& coverage = layer.coverage[triangle];
          const FixedRect part = lens.samples_of(common_part(tile, coverage.pixels));
          if (reach(coverage, part, 7U).is_none) continue;
          own = std::max(own, most_inverse_depth(coverage.depth, part));
        }
      }
      grid.for_each_near(tile,
                         [&](std::size_t near) { nearest[near] = std::max(nearest[near], own); });
    }
  }
  return nearest;
}

// The steepest rays of some pixels.
struct Slopes {
  double x, y;
};
Slopes steepest(const Lens& lens, const PixelRect& pixels) {
  const FixedRect seen = lens.seen_part(lens.samples_of(pixels));
  const uav::CameraModel& c = lens.camera();
  const auto steeper = [](std::int32_t low, std::int32_t high, double focal_px, double centre_px) {
    const auto of = [&](std::int32_t at) {
      return std::abs(static_cast<double>(at) / kSubpixels - centre_px) / focal_px;
    };
    return std::max(of(low), of(high));
  };
  return {steeper(seen.x_low, seen.x_high, c.fx_px, c.cx_px),
          steeper(seen.y_low, seen.y_high, c.fy_px, c.cy_px)};
}

// How far things move in each tile during the view, at most [px].
std::vector<double> motion_by_tile(const View& view, const Lens& lens,
                                   std::span<const double> body_radii_m, const Layer& middle) {
  const TileGrid grid(view.camera);
  const CameraMotion motion(view);
  const double steps = (view.exposure_s + view.readout_s) / view.spacing_s;
  const std::vector<float> nearest = nearest_by_tile(grid, lens, middle);
  std::vector<double> moved_px(grid.size());
  for (int row = 0; row < grid.down; ++row) {
    for (int column = 0; column < grid.across; ++column) {
      const Slopes slopes = steepest(lens, grid.pixels(column, row));
      const std::size_t i = grid.place(column, row);
      moved_px[i] =
          steps * motion.px(view.camera, slopes.x, slopes.y, static_cast<double>(nearest[i]));
    }
  }
  const Instant& end = view.instants.back();
  for (std::size_t body = 0; body < body_radii_m.size(); ++body) {
    const double of_body_px = body_motion_px(view, body, body_radii_m[body]);
    if (of_body_px <= 0.0) continue;
    const Vec3 p_CB = transform(inverse(end.X_WC), end.X_WB[body].p);
    const PixelRect pixels = pixels_of(p_CB, body_radii_m[body], view, lens);
    if (pixels.is_empty()) continue;
    grid.for_each_near(pixels, [&](std::size_t i) { moved_px[i] += of_body_px; });
  }
  return moved_px;
}

// Rows of the largest band in which things move by up to kBand_px, of `moved_px` in all rows.
int choose_band_rows(double moved_px, int rows) {
  if (moved_px <= kStill_px) return 0;
  const double most = rows * kBand_px / moved_px;
  if (most >= rows) return 0;
  if (most >= kTile_px) return static_cast<int>(most) / kTile_px * kTile_px;
  return std::max(1, static_cast<int>(most) / kMinBandRows) * kMinBandRows;
}

int layers_for(double exposed_px) {
  if (exposed_px <= kStill_px) return 1;
  int layers = 3;
  while (layers < exposed_px && layers < kMaxLayers) layers *= 3;
  return layers;
}

}  // namespace

Sampling::Sampling(const View& view, const Lens& lens, std::span<const double> body_radii_m,
                   const Layer& middle)
    : across_(tiles_across(lens)) {
  const std::vector<double> moved_px = motion_by_tile(view, lens, body_radii_m, middle);
  const double window_s = view.exposure_s + view.readout_s;
  for (const double px : moved_px) {
    exposed_px_.push_back(static_cast<float>(px * view.exposure_s / window_s));
  }
  const double most_px = *std::max_element(moved_px.begin(), moved_px.end());
  band_rows_ = choose_band_rows(most_px * view.readout_s / window_s, view.camera.height_px);
}

double Sampling::exposed_px(const Tile& tile) const {
  if (exposed_px_.empty()) return 0.0;
  float most = 0.0F;
  for (int row = tile.y / kTile_px; row <= (tile.y + tile.height - 1) / kTile_px; ++row) {
    const int place = row * across_ + tile.x / kTile_px;
    most = std::max(most, exposed_px_[static_cast<std::size_t>(place)]);
  }
  return static_cast<double>(most);
}

int Sampling::layers(const Tile& tile) const {
  return layers_for(exposed_px(tile));
}

int Sampling::most_layers() const {
  if (exposed_px_.empty()) return 1;
  return layers_for(static_cast<double>(*std::max_element(exposed_px_.begin(), exposed_px_.end())));
}

double before_end_s(const View& view, double row, int layer, int layers) {
  const int rows = view.camera.height_px;
  const double late_s = rows == 1 ? 0.0 : view.readout_s * (rows - 1 - row) / (rows - 1);
  return late_s + view.exposure_s * (1.0 - (layer + 0.5) / layers);
}

}  // namespace tether::raster
