#include "image_warp.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tether::sim {
namespace {

constexpr int kMaxSize_px = 4096;
constexpr double kMaxTangent = 10.0;  // about 84° off the axis

// The extent of all viewing directions at z = 1.
struct Extent {
  double min_x = std::numeric_limits<double>::infinity(), max_x = -min_x;
  double min_y = min_x, max_y = -min_x;

  void include(const uav::Vec3& p) {
    min_x = std::min(min_x, p.x);
    max_x = std::max(max_x, p.x);
    min_y = std::min(min_y, p.y);
    max_y = std::max(max_y, p.y);
  }
};

using Directions = std::vector<std::optional<uav::Vec3>>;

Directions viewing_directions(const uav::CameraModel& camera) {
  const uav::PixelRays rays(camera);
  Directions directions;
  directions.reserve(static_cast<std::size_t>(camera.width_px) *
                     static_cast<std::size_t>(camera.height_px));
  for (int row = 0; row < camera.height_px; ++row) {
    for (int column = 0; column < camera.width_px; ++column) {
      auto p = rays.at({static_cast<double>(column), static_cast<double>(row)});
      if (p) p->x = std::clamp(p->x, -kMaxTangent, kMaxTangent);
      if (p) p->y = std::clamp(p->y, -kMaxTangent, kMaxTangent);
      directions.push_back(p);
    }
  }
  return directions;
}

Extent extent_of(const Directions& directions) {
  Extent extent;
  for (const auto& p : directions) {
    if (p) extent.include(*p);
  }
  if (extent.min_x > extent.max_x) extent.include({0.0, 0.0, 1.0});
  return extent;
}

// One pixel of margin on each side, so that every lookup has four neighbours.
uav::CameraModel ideal_camera(const Extent& extent, double wanted_focal_px) {
  const double span = std::max(extent.max_x - extent.min_x, extent.max_y - extent.min_y);
  const double focal_px =
      span > 0.0 ? std::min(wanted_focal_px, (kMaxSize_px - 3) / span) : wanted_focal_px;
  uav::CameraModel ideal;
  ideal.width_px = static_cast<int>(std::ceil(focal_px * (extent.max_x - extent.min_x))) + 3;
  ideal.height_px = static_cast<int>(std::ceil(focal_px * (extent.max_y - extent.min_y))) + 3;
  ideal.fx_px = ideal.fy_px = focal_px;
  ideal.cx_px = 1.0 - focal_px * extent.min_x;
  ideal.cy_px = 1.0 - focal_px * extent.min_y;
  return ideal;
}

std::uint8_t mix(const std::uint8_t* const corners[4], const float weights[4], int channel) {
  float sum = 0.5F;
  for (int i = 0; i < 4; ++i) sum += weights[i] * static_cast<float>(corners[i][channel]);
  return static_cast<std::uint8_t>(sum);
}

}  // namespace

bool ImageWarp::is_needed(const uav::CameraModel& camera) {
  return camera.has_distortion() || std::abs(camera.fx_px - camera.fy_px) > 1e-9 * camera.fx_px;
}

ImageWarp::ImageWarp(const uav::CameraModel& camera) {
  const Directions directions = viewing_directions(camera);
  source_ = ideal_camera(extent_of(directions), std::max(camera.fx_px, camera.fy_px));
  lookup_.reserve(directions.size());
  for (const auto& p : directions) {
    if (!p) ++blind_pixels_;
    lookup_.push_back(
        p ? uav::Pixel{source_.cx_px + source_.fx_px * p->x, source_.cy_px + source_.fy_px * p->y}
          : uav::Pixel{-1.0, -1.0});
  }
}

void ImageWarp::apply(std::span<const std::uint8_t> ideal_rgb, std::span<std::uint8_t> rgb) const {
  const auto stride = 3 * static_cast<std::ptrdiff_t>(source_.width_px);
  std::uint8_t* out = rgb.data();
  for (const uav::Pixel& at : lookup_) {
    if (at.u_px < 0.0) {
      out = std::fill_n(out, 3, std::uint8_t{0});
      continue;
    }
    const int column = static_cast<int>(at.u_px);
    const int row = static_cast<int>(at.v_px);
    const auto a = static_cast<float>(at.u_px - column);
    const auto b = static_cast<float>(at.v_px - row);
    const std::uint8_t* const corner = ideal_rgb.data() + row * stride + std::ptrdiff_t{3} * column;
    const std::uint8_t* const corners[4] = {corner, corner + 3, corner + stride,
                                            corner + stride + 3};
    const float weights[4] = {(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b};
    for (int channel = 0; channel < 3; ++channel) *out++ = mix(corners, weights, channel);
  }
}

}  // namespace tether::sim
