#include "clip.h"
#include "layer.h"
#include "transform.h"

#include <algorithm>
#include <cmath>

namespace tether::raster {
namespace {

using uav::Pose;
using uav::Vec3;

// The field of view of a strip's pixels, as slopes at z = 1.
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

// A plane over the picture, of a function that is linear in the ray (X, Y, 1).
std::array<float, 3> over_picture(const Vec3& linear, const Projection& p, double x_ref,
                                  double y_ref) {
  const double value =
      linear.x * ((x_ref - p.cx) / p.fx) + linear.y * ((y_ref - p.cy) / p.fy) + linear.z;
  return {static_cast<float>(value), static_cast<float>(linear.x / p.fx),
          static_cast<float>(linear.y / p.fy)};
}

// Whether no result computed with the plane becomes infinite.
bool is_usable(const std::array<float, 3>& plane) {
  constexpr float kSteepest = 1e15F;
  return std::abs(plane[0]) < kSteepest && std::abs(plane[1]) < kSteepest &&
         std::abs(plane[2]) < kSteepest;
}

Transformation make_transformation(const Pose& X_CV, const Projection& p) {
  Transformation t{};
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

std::array<float, 3> rotated(const std::array<float, 9>& r, const std::array<float, 3>& v) {
  return {r[0] * v[0] + r[1] * v[1] + r[2] * v[2], r[3] * v[0] + r[4] * v[1] + r[5] * v[2],
          r[6] * v[0] + r[7] * v[1] + r[8] * v[2]};
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
        frustum_(lens.samples_of_rows(strip.first_row, strip.first_row + strip.rows - 1),
                 layer.projection),
        across_(tiles_across(lens)) {}

  void place_all() {
    const int tile_rows = (strip_.rows + kTile_px - 1) / kTile_px;
    layer_.coverage.clear();
    layer_.facets.clear();
    for (auto* lists : {&layer_.opaque, &layer_.transparent}) {
      lists->resize(place_of(0, tile_rows));
      for (auto& list : *lists) list.clear();
    }
    if (lens_.samples_of_rows(strip_.first_row, strip_.first_row + strip_.rows - 1).is_empty()) {
      return;
    }
    for (const PreparedInstance& instance : scene_.instances) {
      if (is_selected(instance)) place(instance);
    }
  }

 private:
  bool is_selected(const PreparedInstance& i) const {
    const bool is_hidden =
        selection_.hidden && i.body == static_cast<std::int32_t>(*selection_.hidden);
    return !is_hidden && (!selection_.only_casters || i.cast_shadows) &&
           (!selection_.only_fixed || i.body < 0) && (!selection_.only_moving || i.body >= 0);
  }

  void place(const PreparedInstance& instance) {
    const PreparedMesh& mesh = scene_.meshes[instance.mesh];
    const Pose X_WV = instance.body < 0
                          ? instance.X_BV
                          : layer_.X_WB[static_cast<std::size_t>(instance.body)] * instance.X_BV;
    const Pose X_CV = layer_.X_CW * X_WV;
    if (mesh.clusters == 0 || !may_see(X_CV, mesh.bounds)) return;
    instance_ = &instance;
    looks_ = scene_.looks.data() + mesh.first_look;
    transformation_ = make_transformation(X_CV, layer_.projection);
    const std::uint32_t first_triangle = scene_.clusters[mesh.first_cluster].first_triangle;
    for (std::uint32_t i = 0; i < mesh.clusters; ++i) {
      const Cluster& cluster = scene_.clusters[mesh.first_cluster + i];
      if (mesh.clusters > 1 && !may_see(X_CV, cluster.bounds)) continue;
      place(cluster, instance.first_primitive + cluster.first_triangle - first_triangle);
    }
  }

  bool may_see(const Pose& X_CV, const Sphere& bounds) const {
    return frustum_.may_see(transform(X_CV, bounds.centre), bounds.radius_m * kSlack);
  }

  void place(const Cluster& cluster, std::uint32_t first_primitive) {
    place_vertices(scene_, cluster, transformation_, placed_);
    for (std::uint32_t i = 0; i < cluster.triangles; ++i) {
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
    const auto& outside = placed_.outside;
    const std::int32_t a = outside[corners_[0]];
    const std::int32_t b = outside[corners_[1]];
    const std::int32_t c = outside[corners_[2]];
    if ((a & b & c) != 0) return;
    if ((a | b | c) == 0) {
      cover(point(0), point(1), point(2));
      return;
    }
    Polygon polygon;
    for (std::size_t i = 0; i < 3; ++i) {
      polygon.add({position(i), point(i), outside[corners_[i]] == 0});
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
    PixelRect pixels = lens_.pixels_of(bounds);
    pixels.y_low = std::max(pixels.y_low, strip_.first_row);
    pixels.y_high = std::min(pixels.y_high, strip_.first_row + strip_.rows - 1);
    if (pixels.is_empty()) return;
    Coverage coverage{};
    coverage.pixels = pixels;
    const FixedPoint& second = area < 0 ? r : q;
    const FixedPoint& third = area < 0 ? q : r;
    set_edge(coverage, 0, p, second);
    set_edge(coverage, 1, second, third);
    set_edge(coverage, 2, third, p);
    if (lens_.is_grid() && is_between_pixels(coverage)) return;
    layer_.coverage.push_back(coverage);
    add_facet(lens_.seen_part(bounds));
    add_to_tiles(pixels);
  }

  std::size_t place_of(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(across_) +
           static_cast<std::size_t>(column);
  }

  void add_to_tiles(const PixelRect& pixels) {
    auto& lists = instance_->transparent ? layer_.transparent : layer_.opaque;
    const auto index = static_cast<std::uint32_t>(layer_.coverage.size() - 1);
    const int last_row = (pixels.y_high - strip_.first_row) / kTile_px;
    for (int row = (pixels.y_low - strip_.first_row) / kTile_px; row <= last_row; ++row) {
      for (int column = pixels.x_low / kTile_px; column <= pixels.x_high / kTile_px; ++column) {
        lists[place_of(column, row)].push_back(index);
      }
    }
  }

  // The planes are most exact near the middle of the triangle's visible part.
  void add_facet(const FixedRect& seen) {
    Facet& facet = layer_.facets.emplace_back();
    const std::int32_t x = (seen.x_low + seen.x_high) / 2;
    const std::int32_t y = (seen.y_low + seen.y_high) / 2;
    const double x_ref = static_cast<double>(x) / kSubpixels;
    const double y_ref = static_cast<double>(y) / kSubpixels;
    facet.x_ref = static_cast<float>(x_ref);
    facet.y_ref = static_cast<float>(y_ref);
    set_planes(facet, x_ref, y_ref);
    set_look(facet);
    facet.material = instance_->material;
    facet.primitive = primitive_;
    facet.entity = instance_->entity;
  }

  // With the corners as columns of M, M⁻¹·(X, Y, 1) are the corners' weights over z.
  void set_planes(Facet& facet, double x_ref, double y_ref) {
    const Vec3 a = position(0);
    const Vec3 b = position(1);
    const Vec3 c = position(2);
    const Vec3 normal = cross(b - a, c - a);
    const double determinant = dot(a, normal);
    const double scale = 1.0 / determinant;
    const Projection& p = layer_.projection;
    const double low = 1.0 / std::max({a.z, b.z, c.z});
    const double high = 1.0 / std::max(p.near_m, std::min({a.z, b.z, c.z}));
    facet.inverse_depth_low = static_cast<float>(low);
    facet.inverse_depth_high = static_cast<float>(high);
    facet.inverse_depth = over_picture(scale * normal, p, x_ref, y_ref);
    facet.second = over_picture(scale * cross(c, a), p, x_ref, y_ref);
    facet.third = over_picture(scale * cross(a, b), p, x_ref, y_ref);
    if (is_usable(facet.inverse_depth) && is_usable(facet.second) && is_usable(facet.third)) {
      return;
    }
    // The triangle is seen edge-on: constant values.
    facet.inverse_depth = {facet.inverse_depth_high, 0.0F, 0.0F};
    facet.second = facet.third = {facet.inverse_depth_high / 3.0F, 0.0F, 0.0F};
  }

  void set_look(Facet& facet) {
    const auto& looks = scene_.triangles[triangle_];
    const VertexLook& a = looks_[looks[0]];
    const VertexLook& b = looks_[looks[1]];
    const VertexLook& c = looks_[looks[2]];
    const MaterialRow& material = scene_.materials[instance_->material];
    set_coordinate(facet, {a.uv[0], b.uv[0], c.uv[0]}, material.texture_width, facet.u);
    set_coordinate(facet, {a.uv[1], b.uv[1], c.uv[1]}, material.texture_height, facet.v);
    const auto na = rotated(transformation_.rotation, a.normal);
    facet.is_flat = a.normal == b.normal && a.normal == c.normal ? -1 : 0;
    if (facet.is_flat != 0) {
      for (std::size_t i = 0; i < 3; ++i) facet.normal[i] = {na[i], 0.0F, 0.0F};
      return;
    }
    const auto nb = rotated(transformation_.rotation, b.normal);
    const auto nc = rotated(transformation_.rotation, c.normal);
    for (std::size_t i = 0; i < 3; ++i) facet.normal[i] = {na[i], nb[i] - na[i], nc[i] - na[i]};
  }

  static void set_coordinate(const Facet& facet, const std::array<float, 3>& corners, float texels,
                             Facet::Coordinate& out) {
    const float second = corners[1] - corners[0];
    const float third = corners[2] - corners[0];
    out.first = corners[0];
    out.low = std::min({0.0F, second, third});
    out.high = std::max({0.0F, second, third});
    for (std::size_t i = 0; i < 3; ++i) {
      out.added[i] = second * facet.second[i] + third * facet.third[i];
    }
    for (std::size_t i = 0; i < 2; ++i) {
      out.change[i] = texels * out.added[i + 1];
      out.shrinkage[i] = texels * facet.inverse_depth[i + 1];
    }
  }

  static constexpr double kSlack = 1.0 + 1e-5;  // of transformations in single precision

  const PreparedScene& scene_;
  const Lens& lens_;
  const Strip& strip_;
  const Selection& selection_;
  Layer& layer_;
  Frustum frustum_;
  int across_;
  PlacedVertices placed_;
  Transformation transformation_{};
  const PreparedInstance* instance_ = nullptr;
  const VertexLook* looks_ = nullptr;
  std::array<std::uint32_t, 3> corners_{};  // of `placed_`
  std::size_t triangle_ = 0;
  std::uint32_t primitive_ = 0;
};

}  // namespace

void place_triangles(const PreparedScene& scene, const Lens& lens, const Strip& strip,
                     const Selection& selection, Layer& layer) {
  Placer(scene, lens, strip, selection, layer).place_all();
}

}  // namespace tether::raster
