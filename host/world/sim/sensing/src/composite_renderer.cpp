// Puts a picture together from ideal views: the instants of the shutter are drawn (`draw_instant`),
// as many as the motion in the picture requires, and their rows are mixed by weight (`mix`). A lens
// is applied to each view by ImageWarp.

#include "composite_renderer.h"

#include "shutter.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <tether/sim_raster/renderer.h>

namespace tether::sim {
namespace {

std::size_t bytes_of(const uav::CameraModel& camera) {
  return std::size_t{3} * static_cast<std::size_t>(camera.width_px) *
         static_cast<std::size_t>(camera.height_px);
}

}  // namespace

std::unique_ptr<CameraRenderer> make_composite_renderer(std::unique_ptr<ViewRenderer> views,
                                                        std::vector<double> body_radii_m) {
  raster::check_processor();
  return std::make_unique<CompositeRenderer>(std::move(views), std::move(body_radii_m));
}

ViewSize largest_view(const World& world) {
  ViewSize size;
  for (const Uav& uav : world.uavs) {
    for (const Sensor& sensor : uav.sensors) {
      const auto* camera = std::get_if<CameraModel>(&sensor.model);
      if (!camera) continue;
      const uav::CameraModel& lens = camera->intrinsics;
      const uav::CameraModel drawn = ImageWarp::is_needed(lens) ? ImageWarp(lens).source() : lens;
      size.width_px = std::max(size.width_px, drawn.width_px);
      size.height_px = std::max(size.height_px, drawn.height_px);
    }
  }
  return size;
}

CompositeRenderer::CompositeRenderer(std::unique_ptr<ViewRenderer> views,
                                     std::vector<double> body_radii_m)
    : views_(std::move(views)), body_radii_m_(std::move(body_radii_m)) {}

// The view of the last instant tells how near things are, and thereby how far they move.
void CompositeRenderer::draw(const raster::View& view, const raster::Picture& picture) {
  assert(picture.depth_m.empty() && picture.entity.empty() && !view.antialias);
  draw_instant(view, 0.0, {0, view.camera.height_px}, picture.rgb);
  if (window_s(view) <= 0.0) return;
  const int instants =
      count_instants(raster::motion_px(view, body_radii_m_, views_->nearest_depth_m()));
  if (instants > 1) mix(view, instants, picture.rgb);
}

std::size_t CompositeRenderer::blind_pixels(const uav::CameraModel& camera) {
  const ImageWarp* const warp = warp_of(camera);
  return warp == nullptr ? 0 : warp->blind_pixels();
}

// Rows of the picture of one instant, through the lens, to where they are in `rgb`. @pre all rows
// for a camera with a warp.
void CompositeRenderer::draw_instant(const raster::View& view, double before_end_s,
                                     const Rows& rows, Bytes rgb) {
  raster::interpolate(view, before_end_s, moment_);
  const auto X_WB =
      std::span(moment_.X_WB).first(body_radii_m_.size());  // the others draw no parts
  View ideal{view.camera, view.near_m, view.far_m, {}, X_WB, view.hidden};
  ideal.X_WS = moment_.X_WC * inverse(uav::Pose{{}, uav::q_body_from_optical()});
  ideal.with_depth = before_end_s == 0.0 && window_s(view) > 0.0;
  if (const ImageWarp* const warp = warp_of(view.camera)) {
    ideal.camera = warp->source();
    ideal_rgb_.resize(bytes_of(ideal.camera));
    views_->render(ideal, ideal_rgb_);
    warp->apply(ideal_rgb_, rgb);
    return;
  }
  ideal.camera.height_px = rows.count;
  ideal.camera.cy_px -= rows.first;
  const std::size_t stride = 3 * static_cast<std::size_t>(view.camera.width_px);
  views_->render(
      ideal, rgb.subspan(stride * static_cast<std::size_t>(rows.first), bytes_of(ideal.camera)));
}

// `rgb` is the picture of the last instant, and becomes the mix. Only rows that an instant's light
// reaches are drawn; but any row of a warped picture may come from any row of what is drawn.
void CompositeRenderer::mix(const raster::View& view, int instants, Bytes rgb) {
  light_.clear(rgb.size());
  instant_rgb_.resize(rgb.size());
  for (int i = 0; i + 1 < instants; ++i) {
    Rows rows{0, view.camera.height_px};
    const auto is_dark = [&](int row) { return row_weight(view, row, i, instants) == 0.0; };
    const bool is_whole = warp_of(view.camera) != nullptr;
    while (!is_whole && rows.count > 1 && is_dark(rows.first)) ++rows.first, --rows.count;
    while (!is_whole && rows.count > 1 && is_dark(rows.first + rows.count - 1)) --rows.count;
    draw_instant(view, window_s(view) * (instants - 1 - i) / (instants - 1), rows, instant_rgb_);
    add_rows(view, i, instants, instant_rgb_);
  }
  add_rows(view, instants - 1, instants, rgb);
  light_.encode(rgb);
}

void CompositeRenderer::add_rows(const raster::View& view, int instant, int instants, Bytes rgb) {
  const std::size_t stride = rgb.size() / static_cast<std::size_t>(view.camera.height_px);
  for (int row = 0; row < view.camera.height_px; ++row) {
    const double weight = row_weight(view, row, instant, instants);
    if (weight == 0.0) continue;
    const std::size_t first = static_cast<std::size_t>(row) * stride;
    light_.add(first, rgb.subspan(first, stride), weight);
  }
}

// None for an ideal camera.
const ImageWarp* CompositeRenderer::warp_of(const uav::CameraModel& camera) {
  if (!ImageWarp::is_needed(camera)) return nullptr;
  const auto known = std::find_if(warps_.begin(), warps_.end(),
                                  [&](const auto& warp) { return warp.first == camera; });
  if (known != warps_.end()) return &known->second;
  return &warps_.emplace_back(camera, ImageWarp(camera)).second;
}

}  // namespace tether::sim
