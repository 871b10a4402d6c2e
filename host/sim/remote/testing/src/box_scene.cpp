#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <tether/sim/bodies.h>
#include <tether/sim_remote_testing/box_scene.h>

namespace tether::sim::testing {
namespace {

std::array<double, 3> parts(const uav::Vec3& v) {
  return {v.x, v.y, v.z};
}

/// Where a ray enters a box about the origin; a box that it begins in is not met.
std::optional<double> entry_m(const uav::Vec3& origin, const uav::Vec3& ray,
                              const uav::Vec3& half_m) {
  double first = -std::numeric_limits<double>::infinity();
  double last = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const double at = parts(origin)[i];
    const double along = parts(ray)[i];
    const double half = parts(half_m)[i];
    if (along == 0.0) {
      if (std::abs(at) > half) return std::nullopt;
      continue;
    }
    const auto [near, far] = std::minmax({(-half - at) / along, (half - at) / along});
    first = std::max(first, near);
    last = std::min(last, far);
  }
  if (first > last || first < 0.0) return std::nullopt;
  return first;
}

}  // namespace

BoxScene::BoxScene(const World& world) {
  for (const FixedBody& body : fixed_bodies(world)) add(*body.link, std::nullopt, body.X_WB);
  const std::vector<MovingBody> moving = moving_bodies(world);
  for (std::size_t i = 0; i < moving.size(); ++i) add(*moving[i].link, i, {});
}

void BoxScene::add(const Link& link, std::optional<std::size_t> body, const uav::Pose& X_WL) {
  for (const Visual& visual : link.visuals) {
    if (const auto* box = std::get_if<BoxGeometry>(&visual.geometry)) {
      boxes_.push_back(
          {body, X_WL * visual.X_LV, 0.5 * box->size_m, visual.material.diffuse_rgb, true});
    }
  }
  for (const Collision& collision : link.collisions) {
    if (const auto* box = std::get_if<BoxGeometry>(&collision.geometry)) {
      boxes_.push_back({body, X_WL * collision.X_LC, 0.5 * box->size_m, {}, false});
    }
  }
}

std::optional<BoxScene::Hit> BoxScene::first_hit(const uav::Vec3& origin_W, const uav::Vec3& ray_W,
                                                 std::span<const uav::Pose> X_WB,
                                                 std::optional<std::uint32_t> without,
                                                 bool seen) const {
  std::optional<Hit> hit;
  for (const Box& box : boxes_) {
    if (box.seen != seen || (without && box.body == *without)) continue;
    const uav::Pose X_WX = box.body ? X_WB[*box.body] * box.X : box.X;
    const uav::Pose X_XW = inverse(X_WX);
    const auto distance_m = entry_m(transform(X_XW, origin_W), rotate(X_XW.q, ray_W), box.half_m);
    if (distance_m && (!hit || *distance_m < hit->distance_m)) hit = Hit{*distance_m, box.rgb};
  }
  return hit;
}

}  // namespace tether::sim::testing
