#include "place/clip.h"
#include "place/facet.h"
#include "place/layer.h"
#include "place/transform.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tether::raster {
namespace {

using uav::Pose;
using uav::Vec3;

// The field of view of some pixels, as slopes at z = 1.
class Frustum {
 public:
  Frustum(const FixedRect& seen, const Projection& p)
      : near_m_(p.near_m),
        sides_{side(seen.x_low - kMargin, p.fx, p.cx), side(seen.x_high + kMargin, p.fx, p.cx),
               side(seen.y_low - kMargin, p.fy, p.cy), side(seen.y_high + kMargin, p.fy, p.cy)} {}

  bool may_see(const Vec3& p, double radius_m) const {
    return p.z + radius_m >= near_m_ && is_inside(p.x, p.z, sides_[0], radius_m) &&
           is_inside(-p.x, p.z, sides_[1].mirrored(), radius_m) &&
           is_inside(p.y, p.z, sides_[2], radius_m) &&
           is_inside(-p.y, p.z, sides_[3].mirrored(), radius_m);
  }

 private:
  static constexpr int kMargin = kSubpixels;
  struct Side {
    double slope, length;
    Side mirrored() const { return {-slope, length}; }
  };

  static Side side(int at, double f, double c) {
    const double slope = (static_cast<double>(at) / kSubpixels - c) / f;
    return {slope, std::sqrt(1.0 + slope * slope)};
  }
  static bool is_inside(double x, double z, const Side& low, double radius_m) {
    return x - low.slope * z >= -radius_m * low.length;
  }

  double near_m_;
  std::array<Side, 4> sides_;
};

Transformation make_transformation(const Pose& X_CV, const Projection& p, const FixedRect& seen) {
  Transformation t{};
  t.seen = seen;
  const std::array<Vec3, 3> columns{rotate(X_CV.q, {1.0, 0.0, 0.0}),
                                    rotate(X_CV.q, {0.0, 1.0, 0.0}),
                                    rotate(X_CV.q, {0.0, 0.0, 1.0})};
  for (std::size_t i = 0; i < 3; ++i) {
    t.rotation[i] = static_cast<float>(columns[i].x);
    t.rotation[3 + i] = static_cast<float>(columns[i].y);
    t.rotation[6 + i] = static_cast<float>(columns[i].z);
  }
  t.translation = {static_cast<float>(X_CV.p.x), static_cast<float>(X_CV.p.y),
                   static_cast<float>(X_CV.p.z)};
  t.fx = static_cast<float>(p.fx * kSubpixels);
  t.fy = static_cast<float>(p.fy * kSubpixels);
  t.cx = static_cast<float>(p.cx * kSubpixels);
  t.cy = static_cast<float>(p.cy * kSubpixels);
  t.near_m = static_cast<float>(p.near_m);
  return t;
}

std::int64_t doubled_area(const FixedPoint& a, const FixedPoint& b, const FixedPoint& c) {
  const auto wide = [](std::int32_t v) { return static_cast<std::int64_t>(v); };
  return wide(b.x - a.x) * wide(c.y - a.y) - wide(c.x - a.x) * wide(b.y - a.y);
}

// The edge from p to q. Pixels on it belong to the triangle if its inside is right of the edge, or
// below.
void set_edge(Coverage& coverage, std::size_t i, const FixedPoint& p, const FixedPoint& q) {
  const std::int32_t a = p.y - q.y;
  const std::int32_t b = q.x - p.x;
  const bool owns = a > 0 || (a == 0 && b > 0);
  coverage.a[i] = a;
  coverage.b[i] = b;
  coverage.c[i] =
      -static_cast<std::int64_t>(a) * p.x - static_cast<std::int64_t>(b) * p.y - (owns ? 0 : 1);
}

// Whether a small triangle covers no pixel of a grid, like most of those of a far mesh.
bool is_between_pixels(const Coverage& t) {
  constexpr int kFew = 8;
  const PixelRect& p = t.pixels;
  if ((p.x_high - p.x_low + 1) * (p.y_high - p.y_low + 1) > kFew) return false;
  for (int y = p.y_low; y <= p.y_high; ++y) {
    for (int x = p.x_low; x <= p.x_high; ++x) {
      const auto is_inside = [&](std::size_t i) {
        return t.c[i] + kSubpixels * (std::int64_t{t.a[i]} * x + std::int64_t{t.b[i]} * y) >= 0;
      };
      if (is_inside(0) && is_inside(1) && is_inside(2)) return false;
    }
  }
  return true;
}

class Placer {
 public:
  Placer(const PreparedScene& scene, const Lens& lens, const Strip& strip,
         const Selection& selection, Layer& layer)
      : scene_(scene),
        lens_(lens),
        strip_(strip),
        selection_(selection),
        layer_(layer),
        pixels_(common_part(selection.pixels, {0, strip.first_row, lens.camera().width_px - 1,
                                               strip.first_row + strip.rows - 1})),
        seen_(lens.seen_part(lens.samples_of(pixels_))),
        frustum_(seen_, layer.projection),
        across_(tiles_across(lens)) {}

  void place_all() {
    const int tile_rows = tiles_in(strip_.rows);
    layer_.coverage.clear();
    layer_.visuals.clear();
    for (auto* lists : {&layer_.opaque, &layer_.transparent}) {
      lists->resize(place_of(0, tile_rows));
      for (auto& list : *lists) list.clear();
    }
    find_tile_samples(tile_rows);
    for (const PreparedInstance& instance : scene_.instances) {
      if (is_selected(instance)) place(instance);
    }
    layer_.clear_facets();
  }

 private:
  bool is_selected(const PreparedInstance& i) const {
    const bool is_hidden =
        selection_.hidden && i.hidden_with == static_cast<std::int32_t>(*selection_.hidden);
    return !is_hidden && (!selection_.only_casters || i.cast_shadows) &&
           (!selection_.only_fixed || i.body < 0) && (!selection_.only_moving || i.body >= 0);
  }

  void place(const PreparedInstance& instance) {
    const PreparedMesh& mesh = scene_.meshes[instance.mesh];
    const Pose X_CB = instance.body < 0
                          ? layer_.X_CW
                          : layer_.X_CW * layer_.X_WB[static_cast<std::size_t>(instance.body)];
    if (mesh.clusters == 0 || !may_see(X_CB, instance.bounds_B)) return;
    const Pose X_CV = X_CB * instance.X_BV;
    instance_ = &instance;
    transformation_ = make_transformation(X_CV, layer_.projection, seen_);
    layer_.visuals.push_back(
        {transformation_.rotation, mesh.first_look, instance.material, instance.entity});
    const std::uint32_t first_triangle = scene_.clusters[mesh.first_cluster].first_triangle;
    for (std::uint32_t i = 0; i < mesh.clusters; ++i) {
      const Cluster& cluster = scene_.clusters[mesh.first_cluster + i];
      if (mesh.clusters > 1 && !may_see(X_CV, cluster.bounds)) continue;
      place(cluster, instance.first_primitive + cluster.first_triangle - first_triangle);
    }
  }

  bool may_see(const Pose& X_C, const Sphere& bounds) const {
    return frustum_.may_see(transform(X_C, bounds.centre), bounds.radius_m * kSlack);
  }

  void place(const Cluster& cluster, std::uint32_t first_primitive) {
    const bool both_sides = selection_.both_sides || instance_->transparent;
    std::uint64_t seen = place_vertices(scene_, cluster, transformation_, both_sides, placed_);
    for (; seen != 0; seen &= seen - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(seen));
      corners_ = {i, cluster.stride + i, 2 * cluster.stride + i};
      triangle_ = cluster.first_triangle + i;
      primitive_ = first_primitive + i;
      place_triangle();
    }
  }

  FixedPoint point(std::size_t corner) const {
    return {placed_.u[corners_[corner]], placed_.v[corners_[corner]]};
  }
  Vec3 position(std::size_t corner) const {
    const std::size_t i = corners_[corner];
    return {placed_.x[i], placed_.y[i], placed_.z[i]};
  }

  void place_triangle() {
    const auto is_usable = [&](std::size_t corner) {
      return (placed_.outside[corners_[corner]] & kUnusable) == 0;
    };
    if (is_usable(0) && is_usable(1) && is_usable(2)) {
      cover(point(0), point(1), point(2));
      return;
    }
    Polygon polygon;
    for (std::size_t i = 0; i < 3; ++i) {
      polygon.add({position(i), point(i), is_usable(i)});
    }
    clip(polygon, layer_.projection);
    for (std::size_t i = 2; i < polygon.size; ++i) {
      cover(polygon.points[0].fixed, polygon.points[i - 1].fixed, polygon.points[i].fixed);
    }
  }

  // From the front, corners run counter-clockwise, which is a negative area where y points down.
  // What is transparent shows its sides behind too.
  void cover(const FixedPoint& p, const FixedPoint& q, const FixedPoint& r) {
    const std::int64_t area = doubled_area(p, q, r);
    const bool both_sides = selection_.both_sides || instance_->transparent;
    if (area == 0 || (area > 0 && !both_sides)) return;
    const FixedRect bounds{std::min({p.x, q.x, r.x}), std::min({p.y, q.y, r.y}),
                           std::max({p.x, q.x, r.x}), std::max({p.y, q.y, r.y})};
    Coverage coverage{};
    coverage.pixels = lens_.pixels_of(bounds);
    const PixelRect pixels = common_part(coverage.pixels, pixels_);
    if (pixels.is_empty()) return;
    const FixedPoint& second = area < 0 ? r : q;
    const FixedPoint& third = area < 0 ? q : r;
    set_edge(coverage, 0, p, second);
    set_edge(coverage, 1, second, third);
    set_edge(coverage, 2, third, p);
    if (lens_.is_grid() && is_between_pixels(coverage)) return;
    coverage.pixels = pixels;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t at = corners_[i];
      coverage.corners[i] = {placed_.x[at], placed_.y[at], placed_.z[at]};
    }
    coverage.primitive = primitive_;
    coverage.visual = static_cast<std::uint32_t>(layer_.visuals.size() - 1);
    coverage.triangle = triangle_;
    coverage.depth = depth_of(coverage.corners, layer_.projection, lens_.seen_part(bounds));
    layer_.coverage.push_back(coverage);
    add_to_tiles(pixels, bounds);
  }

  std::size_t place_of(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(across_) +
           static_cast<std::size_t>(column);
  }

  void add_to_tiles(const PixelRect& pixels, const FixedRect& bounds) {
    auto& lists = instance_->transparent ? layer_.transparent : layer_.opaque;
    const auto index = static_cast<std::uint32_t>(layer_.coverage.size() - 1);
    const int last_row = (pixels.y_high - strip_.first_row) / kTile_px;
    for (int row = (pixels.y_low - strip_.first_row) / kTile_px; row <= last_row; ++row) {
      for (int column = pixels.x_low / kTile_px; column <= pixels.x_high / kTile_px; ++column) {
        const std::size_t tile = place_of(column, row);
        if (!tile_samples_.empty() && common_part(bounds, tile_samples_[tile]).is_empty()) continue;
        lists[tile].push_back(index);
      }
    }
  }

  // The pixels of a triangle are known roughly if there is no grid. Which triangles a tile has must
  // not depend on which tiles are placed at once, though.
  void find_tile_samples(int tile_rows) {
    if (lens_.is_grid()) return;
    for (int row = 0; row < tile_rows; ++row) {
      for (int column = 0; column < across_; ++column) {
        const int x = column * kTile_px;
        const int y = strip_.first_row + row * kTile_px;
        const PixelRect whole{x, y, x + kTile_px - 1, y + kTile_px - 1};
        tile_samples_.push_back(lens_.seen_part(lens_.samples_of(common_part(whole, pixels_))));
      }
    }
  }

  static constexpr double kSlack = 1.0 + 1e-5;  // of transformations in single precision

  const PreparedScene& scene_;
  const Lens& lens_;
  const Strip& strip_;
  const Selection& selection_;
  Layer& layer_;
  PixelRect pixels_;
  FixedRect seen_;
  std::vector<FixedRect> tile_samples_;  // empty for a grid
  Frustum frustum_;
  int across_;
  PlacedVertices placed_;
  Transformation transformation_{};
  const PreparedInstance* instance_ = nullptr;
  std::array<std::uint32_t, 3> corners_{};  // of `placed_`
  std::uint32_t triangle_ = 0;
  std::uint32_t primitive_ = 0;
};

}  // namespace

void place_triangles(const PreparedScene& scene, const Lens& lens, const Strip& strip,
                     const Selection& selection, Layer& layer) {
  Placer(scene, lens, strip, selection, layer).place_all();
}

}  // namespace tether::raster
