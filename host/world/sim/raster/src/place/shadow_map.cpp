#include "place/shadow_map.h"

#include "scene/trigonometry.h"

#include <algorithm>
#include <cmath>

namespace tether::raster {
namespace {

using uav::Pose;
using uav::Quat;
using uav::Vec3;

constexpr double kWidest_rad = 1.3962634015954636;  // 80°
constexpr double kNear_m = 0.05;
// The sun is this many times as far away as the world and its casters are large: its rays are as
// good as parallel, and depths still differ.
constexpr double kSunPerWorld = 100.0;
constexpr double kSunPerCasters = 1000.0;

// The rotation that turns z to `direction`, which is unit.
Quat rotation_from_z(const Vec3& direction) {
  constexpr double kOpposite = 1e-9;
  const Vec3 axis = cross({0.0, 0.0, 1.0}, direction);
  if (1.0 + direction.z < kOpposite) return {0.0, 1.0, 0.0, 0.0};
  return uav::normalized({1.0 + direction.z, axis.x, axis.y, axis.z});
}

uav::CameraModel camera() {
  uav::CameraModel c;
  c.width_px = c.height_px = ShadowMap::kSize_px;
  c.fx_px = c.fy_px = c.width_px;  // each layer has its own
  c.cx_px = c.cy_px = 0.5 * (ShadowMap::kSize_px - 1);
  return c;
}

Box around(const Vec3& centre, double radius_m) {
  const Vec3 r{radius_m, radius_m, radius_m};
  return {centre - r, centre + r};
}

// Around all casters, at least 1 cm.
Sphere sphere_of(const Box& casters) {
  constexpr double kLeast_m = 0.01;
  if (casters.is_empty()) return {{}, kLeast_m};
  return {casters.centre(), std::max(kLeast_m, casters.sphere().radius_m)};
}

// How far a fixed visual's box reaches in a direction.
double reach_m(const PreparedScene& scene, const PreparedInstance& i, const Vec3& direction_W) {
  const Box& box = scene.meshes[i.mesh].box;
  const Vec3 d = rotate(uav::inverse(i.X_BV.q), direction_W);
  const Vec3 half = box.half();
  return dot(direction_W, i.X_BV.p) + dot(d, box.centre()) + std::abs(d.x) * half.x +
         std::abs(d.y) * half.y + std::abs(d.z) * half.z;
}

// Whether a thin visual has all else that is fixed on its lit side, like a floor: its shadow falls
// on nothing.
bool is_backdrop(const PreparedScene& scene, const PreparedInstance& slab, const Vec3& light_W) {
  constexpr double kThin = 0.02;
  constexpr double kTolerance_m = 1e-3;
  const Vec3 half = scene.meshes[slab.mesh].box.half();
  const double least_m = std::min({half.x, half.y, half.z});
  if (least_m > kThin * std::max({half.x, half.y, half.z})) return false;
  Vec3 axis{1.0, 0.0, 0.0};
  if (half.y == least_m) axis = {0.0, 1.0, 0.0};
  if (half.z == least_m) axis = {0.0, 0.0, 1.0};
  Vec3 away_W = rotate(slab.X_BV.q, axis);
  if (dot(away_W, light_W) < 0.0) away_W = -1.0 * away_W;
  const double end_m = reach_m(scene, slab, away_W) + kTolerance_m;
  return std::all_of(scene.instances.begin(), scene.instances.end(), [&](const auto& i) {
    return i.body >= 0 || reach_m(scene, i, away_W) <= end_m;
  });
}

template <class Wanted>
Sphere sphere_of_fixed(const PreparedScene& scene, const Wanted& is_wanted) {
  Box box = Box::none();
  for (const PreparedInstance& i : scene.instances) {
    const Sphere& s = scene.meshes[i.mesh].bounds;
    if (i.body < 0 && is_wanted(i)) box.include(around(transform(i.X_BV, s.centre), s.radius_m));
  }
  return sphere_of(box);
}

// Around those whose shadows fall on something.
Sphere sphere_of_casters(const PreparedScene& scene, double fixed_radius_m, const Vec3& light_W) {
  constexpr double kLarge = 0.25;
  int left = 16;  // large visuals that are compared with all others
  return sphere_of_fixed(scene, [&](const PreparedInstance& i) {
    if (!i.cast_shadows) return false;
    if (scene.meshes[i.mesh].bounds.radius_m < kLarge * fixed_radius_m || left-- <= 0) return true;
    return !is_backdrop(scene, i, light_W);
  });
}

constexpr int kAcross = ShadowMap::kSize_px / kTile_px;

// The first pixel of each of a tile's rows in the map, and in the tile.
template <class Use>
void for_each_row(std::size_t tile, Use use) {
  const std::size_t column = tile % kAcross * kTile_px;
  const std::size_t row = tile / kAcross * kTile_px;
  for (std::size_t y = 0; y < kTile_px; ++y) {
    use((row + y) * ShadowMap::kSize_px + column, y * kTile_px);
  }
}

}  // namespace

ShadowMap::ShadowMap(const PreparedScene& scene, const Light& light, Casters casters)
    : scene_(scene),
      light_(light),
      casters_(casters),
      fixed_radius_m_(
          sphere_of_fixed(scene, [](const PreparedInstance&) { return true; }).radius_m),
      lens_(camera()),
      map_(std::size_t{kSize_px} * kSize_px, 0.0F) {
  if (casters == Casters::kBodies) return;
  aim_at(sphere_of_casters(scene, fixed_radius_m_, light.direction_W));
  draw({});
}

void ShadowMap::aim_at(const Sphere& casters) {
  const uav::CameraModel& c = lens_.camera();
  Pose X_WL{light_.p_WL, rotation_from_z(light_.direction_W)};
  double near_m = kNear_m;
  double focal_px = 0.5 * (kSize_px - 1);
  if (light_.kind == LightKind::kDirectional) {
    const double distance_m =
        std::max(kSunPerCasters * casters.radius_m, kSunPerWorld * fixed_radius_m_);
    X_WL.p = casters.centre - distance_m * light_.direction_W;
    near_m = 0.5 * distance_m;
    focal_px *= distance_m / casters.radius_m;
  } else {
    constexpr double kNarrowest_rad = 0.001;
    const double angle = std::clamp(light_.spot_half_angle_rad, kNarrowest_rad, kWidest_rad);
    focal_px *= cosine(angle) / sine(angle);
  }
  layer_.X_CW = inverse(X_WL);
  layer_.projection = {focal_px, focal_px, c.cx_px, c.cy_px, near_m};
}

void ShadowMap::update(std::span<const Pose> X_WB, std::optional<std::size_t> hidden) {
  if (casters_ == Casters::kFixed) return;
  for (const std::size_t tile : drawn_tiles_) {
    for_each_row(tile, [&](std::size_t in_map, std::size_t /*in_tile*/) {
      std::fill_n(map_.data() + in_map, kTile_px, 0.0F);
    });
  }
  drawn_tiles_.clear();
  layer_.X_WB.assign(X_WB.begin(), X_WB.end());
  Box bodies = Box::none();
  for (std::size_t i = 0; i < scene_.body_radii_m.size(); ++i) {
    if (i != hidden) bodies.include(around(X_WB[i].p, scene_.body_radii_m[i]));
  }
  aim_at(sphere_of(bodies));
  draw(hidden);
}

void ShadowMap::draw(std::optional<std::size_t> hidden) {
  Selection selection;
  selection.only_casters = selection.both_sides = true;
  selection.only_fixed = casters_ == Casters::kFixed;
  selection.only_moving = casters_ == Casters::kBodies;
  selection.hidden = hidden;
  place_triangles(scene_, lens_, {0, kSize_px}, selection, layer_);
  for (std::size_t i = 0; i < layer_.opaque.size(); ++i) {
    if (layer_.opaque[i].empty()) continue;
    draw_tile(i);
    drawn_tiles_.push_back(i);
  }
}

void ShadowMap::draw_tile(std::size_t index) {
  const Tile tile{static_cast<int>(index) % kAcross * kTile_px,
                  static_cast<int>(index) / kAcross * kTile_px, kTile_px, kTile_px};
  ids_.inverse_depth.fill(0.0F);
  ids_.id.fill(0);
  rasterize_nearest(layer_, lens_, tile, layer_.opaque[index], Names::kPlaces, ids_);
  for_each_row(index, [&](std::size_t in_map, std::size_t in_tile) {
    std::copy_n(ids_.inverse_depth.data() + in_tile, kTile_px, map_.data() + in_map);
  });
}

std::array<double, 12> ShadowMap::from_world() const {
  const Pose& X = layer_.X_CW;
  const Projection& c = layer_.projection;
  const Quat back = uav::inverse(X.q);
  const Vec3 x = rotate(back, {1.0, 0.0, 0.0});
  const Vec3 y = rotate(back, {0.0, 1.0, 0.0});
  const Vec3 z = rotate(back, {0.0, 0.0, 1.0});
  const Vec3 u = c.fx * x + c.cx * z;
  const Vec3 v = c.fy * y + c.cy * z;
  return {u.x, u.y, u.z, c.fx * X.p.x + c.cx * X.p.z,
          v.x, v.y, v.z, c.fy * X.p.y + c.cy * X.p.z,
          z.x, z.y, z.z, X.p.z};
}

}  // namespace tether::raster
