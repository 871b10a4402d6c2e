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

double late_s(const View& view, double row) {
  const int rows = view.camera.height_px;
  return rows == 1 ? 0.0 : view.readout_s * (rows - 1 - row) / (rows - 1);
}

// What a camera does from an instant to the next, along and about its axes.
struct Step {
  Vec3 shift_m, turn_rad;
};

// The steps in a few parts of the time in which some rows are exposed.
std::vector<Step> steps_of_rows(const View& view, int first_row, int last_row) {
  constexpr std::size_t kParts = 4;
  const std::size_t last = view.instants.size() - 1;
  const auto at = [&](double before_end_s) { return place_among_instants(view, before_end_s); };
  const auto begin =
      std::min(last - 1, static_cast<std::size_t>(at(late_s(view, first_row) + view.exposure_s)));
  const auto end =
      std::max(begin + 1, static_cast<std::size_t>(std::ceil(at(late_s(view, last_row)))));
  const std::size_t part = (end - begin + kParts - 1) / kParts;
  std::vector<Step> steps;
  for (std::size_t from = begin; from < end; from += part) {
    const std::size_t to = std::min(end, from + part);
    const uav::Pose X = inverse(view.instants[from].X_WC) * view.instants[to].X_WC;
    const double share = 1.0 / static_cast<double>(to - from);
    const double twice = X.q.w < 0.0 ? -2.0 : 2.0;
    steps.push_back({share * X.p, share * twice * Vec3{X.q.x, X.q.y, X.q.z}});
  }
  return steps;
}

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
          if (coverage.depth.high <= own) continue;
          const FixedRect part = lens.samples_of(common_part(tile, coverage.pixels));
          const float here = most_inverse_depth(coverage.depth, part);
          if (here > own && !reach(coverage, part, 7U).is_none) own = here;
        }
      }
      grid.for_each_near(tile,
                         [&](std::size_t near) { nearest[near] = std::max(nearest[near], own); });
    }
  }
  return nearest;
}

// The slopes of the rays of some pixels.
struct Slopes {
  double x_low, x_high, y_low, y_high;
};
Slopes slopes_of(const Lens& lens, const PixelRect& pixels) {
  const FixedRect seen = lens.seen_part(lens.samples_of(pixels));
  const uav::CameraModel& c = lens.camera();
  const auto slope = [](std::int32_t at, double focal_px, double centre_px) {
    return (static_cast<double>(at) / kSubpixels - centre_px) / focal_px;
  };
  return {slope(seen.x_low, c.fx_px, c.cx_px), slope(seen.x_high, c.fx_px, c.cx_px),
          slope(seen.y_low, c.fy_px, c.cy_px), slope(seen.y_high, c.fy_px, c.cy_px)};
}

// How far things at rest that are no nearer than 1/inverse_depth move in a step, at most [px].
// Squares of slopes matter between the corners too.
double flow_px(const uav::CameraModel& camera, const Slopes& slopes, double inverse_depth,
               const Step& step) {
  const Vec3& shift = step.shift_m;
  const Vec3& turn = step.turn_rad;
  const auto square_of_half = [](double low, double high) {
    return 0.25 * (high - low) * (high - low);
  };
  const double more_x = std::abs(turn.y) * square_of_half(slopes.x_low, slopes.x_high);
  const double more_y = std::abs(turn.x) * square_of_half(slopes.y_low, slopes.y_high);
  const auto most = [&](double of_turn, double of_shift) {
    return std::max(std::abs(of_turn), std::abs(of_turn + of_shift * inverse_depth));
  };
  double most_px2 = 0.0;
  for (const double x : {slopes.x_low, slopes.x_high}) {
    for (const double y : {slopes.y_low, slopes.y_high}) {
      const double along_x =
          most(turn.x * x * y - turn.y * (1.0 + x * x) + turn.z * y, shift.z * x - shift.x);
      const double along_y =
          most(turn.x * (1.0 + y * y) - turn.y * x * y - turn.z * x, shift.z * y - shift.y);
      const double x_px = camera.fx_px * (along_x + more_x);
      const double y_px = camera.fy_px * (along_y + more_y);
      most_px2 = std::max(most_px2, x_px * x_px + y_px * y_px);
    }
  }
  return std::sqrt(most_px2);
}

// How far things move in each tile during the view, were they as fast throughout as during its own
// exposure, at most [px].
std::vector<double> motion_by_tile(const View& view, const Lens& lens,
                                   std::span<const double> body_radii_m, const Layer& middle) {
  const TileGrid grid(view.camera);
  const double steps = (view.exposure_s + view.readout_s) / view.spacing_s;
  const std::vector<float> nearest = nearest_by_tile(grid, lens, middle);
  std::vector<double> moved_px(grid.size());
  for (int row = 0; row < grid.down; ++row) {
    const PixelRect left = grid.pixels(0, row);
    const std::vector<Step> of_rows = steps_of_rows(view, left.y_low, left.y_high);
    for (int column = 0; column < grid.across; ++column) {
      const Slopes slopes = slopes_of(lens, grid.pixels(column, row));
      const std::size_t i = grid.place(column, row);
      for (const Step& step : of_rows) {
        const double px = flow_px(view.camera, slopes, static_cast<double>(nearest[i]), step);
        moved_px[i] = std::max(moved_px[i], steps * px);
      }
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
  return late_s(view, row) + view.exposure_s * (1.0 - (layer + 0.5) / layers);
}

}  // namespace tether::raster
