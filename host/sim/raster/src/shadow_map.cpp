#include "shadow_map.h"

#include "trigonometry.h"

#include <algorithm>

namespace tether::raster {
namespace {

using uav::Pose;
using uav::Quat;
using uav::Vec3;

constexpr double kWidest_rad = 1.3962634015954636;  // 80°
constexpr double kNear_m = 0.05;
// The sun is this many times as far away as the scene is large: its rays are as good as parallel,
// and depths still differ.
constexpr double kSunDistance = 1000.0;

// The rotation that turns z to `direction`, which is unit.
Quat rotation_from_z(const Vec3& direction) {
  constexpr double kOpposite = 1e-9;
  const Vec3 axis = cross({0.0, 0.0, 1.0}, direction);
  if (1.0 + direction.z < kOpposite) return {0.0, 1.0, 0.0, 0.0};
  return uav::normalized({1.0 + direction.z, axis.x, axis.y, axis.z});
}

uav::CameraModel camera(double focal_px) {
  uav::CameraModel c;
  c.width_px = c.height_px = ShadowMap::kSize_px;
  c.fx_px = c.fy_px = focal_px;
  c.cx_px = c.cy_px = 0.5 * (ShadowMap::kSize_px - 1);
  return c;
}

Sphere sphere_of_fixed(const PreparedScene& scene) {
  Vec3 low{kMaxCoordinate_m, kMaxCoordinate_m, kMaxCoordinate_m};
  Vec3 high = -1.0 * low;
  for (const PreparedInstance& i : scene.instances) {
    const Sphere& s = scene.meshes[i.mesh].bounds;
    if (i.body >= 0) continue;
    const Vec3 c = transform(i.X_BV, s.centre);
    low = {std::min(low.x, c.x - s.radius_m), std::min(low.y, c.y - s.radius_m),
           std::min(low.z, c.z - s.radius_m)};
    high = {std::max(high.x, c.x + s.radius_m), std::max(high.y, c.y + s.radius_m),
            std::max(high.z, c.z + s.radius_m)};
  }
  constexpr double kDefault_m = 10.0;
  if (low.x > high.x) return {{}, kDefault_m};
  return {0.5 * (low + high), std::max(1.0, 0.5 * norm(high - low))};
}

double focal_px(const Light& light) {
  const double half = 0.5 * (ShadowMap::kSize_px - 1);
  if (light.kind == LightKind::kDirectional) return half * kSunDistance;
  constexpr double kNarrowest_rad = 0.001;
  const double angle = std::clamp(light.spot_half_angle_rad, kNarrowest_rad, kWidest_rad);
  return half * cosine(angle) / sine(angle);
}

}  // namespace

ShadowMap::ShadowMap(const PreparedScene& scene, const Light& light)
    : scene_(scene), lens_(camera(focal_px(light))) {
  Pose X_WL{light.p_WL, rotation_from_z(light.direction_W)};
  double near_m = kNear_m;
  if (light.kind == LightKind::kDirectional) {
    const Sphere all = sphere_of_fixed(scene);
    const double distance_m = kSunDistance * all.radius_m;
    X_WL.p = all.centre - distance_m * light.direction_W;
    near_m = 0.5 * distance_m;
  }
  const uav::CameraModel& c = lens_.camera();
  layer_.X_CW = inverse(X_WL);
  layer_.projection = {c.fx_px, c.fy_px, c.cx_px, c.cy_px, near_m};
  fixed_.assign(std::size_t{kSize_px} * kSize_px, 0.0F);
  Selection selection;
  selection.only_casters = selection.only_fixed = selection.both_sides = true;
  draw(selection, fixed_);
  drawn_tiles_.clear();
  now_ = fixed_;
}

void ShadowMap::update(std::span<const Pose> X_WB, std::optional<std::size_t> hidden) {
  for (const std::size_t index : drawn_tiles_) copy_tile(index);
  drawn_tiles_.clear();
  layer_.X_WB.assign(X_WB.begin(), X_WB.end());
  Selection selection;
  selection.only_casters = selection.only_moving = selection.both_sides = true;
  selection.hidden = hidden;
  draw(selection, now_);
}

void ShadowMap::draw(const Selection& selection, std::vector<float>& map) {
  place_triangles(scene_, lens_, {0, kSize_px}, selection, layer_);
  for (std::size_t i = 0; i < layer_.opaque.size(); ++i) {
    if (layer_.opaque[i].empty()) continue;
    draw_tile(i, map);
    drawn_tiles_.push_back(i);
  }
}

namespace {

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

void ShadowMap::draw_tile(std::size_t index, std::vector<float>& map) {
  const Tile tile{static_cast<int>(index) % kAcross * kTile_px,
                  static_cast<int>(index) / kAcross * kTile_px, kTile_px, kTile_px};
  for_each_row(index, [&](std::size_t in_map, std::size_t in_tile) {
    std::copy_n(map.data() + in_map, kTile_px, ids_.inverse_depth.data() + in_tile);
  });
  ids_.id.fill(0);
  rasterize_nearest(layer_, lens_, tile, layer_.opaque[index], ids_);
  for_each_row(index, [&](std::size_t in_map, std::size_t in_tile) {
    std::copy_n(ids_.inverse_depth.data() + in_tile, kTile_px, map.data() + in_map);
  });
}

void ShadowMap::copy_tile(std::size_t index) {
  for_each_row(index, [&](std::size_t in_map, std::size_t /*in_tile*/) {
    std::copy_n(fixed_.data() + in_map, kTile_px, now_.data() + in_map);
  });
}

std::array<double, 12> ShadowMap::from_world() const {
  const Pose& X = layer_.X_CW;
  const uav::CameraModel& c = lens_.camera();
  const Quat back = uav::inverse(X.q);
  const Vec3 x = rotate(back, {1.0, 0.0, 0.0});
  const Vec3 y = rotate(back, {0.0, 1.0, 0.0});
  const Vec3 z = rotate(back, {0.0, 0.0, 1.0});
  const Vec3 u = c.fx_px * x + c.cx_px * z;
  const Vec3 v = c.fy_px * y + c.cy_px * z;
  return {u.x, u.y, u.z, c.fx_px * X.p.x + c.cx_px * X.p.z,
          v.x, v.y, v.z, c.fy_px * X.p.y + c.cy_px * X.p.z,
          z.x, z.y, z.z, X.p.z};
}

}  // namespace tether::raster
