#include "image_maker.h"

#include "pixels.h"
#include "sensor_noise.h"

#include <cassert>
#include <span>
#include <utility>

namespace tether::sim {

ImageMaker::ImageMaker(const World& world, CameraRendererFactory make_renderer,
                       raster::Helpers* helpers, const WarningSink& warn)
    : world_(world),
      layout_(world),
      parts_(turned_parts(world)),
      make_renderer_(std::move(make_renderer)),
      helpers_(helpers),
      warn_(warn) {}

uav::CameraSample ImageMaker::make(const CameraModel& camera, const Request& r) {
  const uav::CameraModel& lens = camera.intrinsics;
  const auto pixels =
      static_cast<std::size_t>(lens.width_px) * static_cast<std::size_t>(lens.height_px);
  const bool has_labels = camera.kind == uav::CameraKind::kSegmentation;
  const bool knows_pixels = renderer().knows_pixels();
  assert(knows_pixels || camera.kind == uav::CameraKind::kColor);
  uav::CameraSample sample{r.key.at, r.key.index, lens.width_px, lens.height_px, {}};
  sample.rgb.resize(uav::has_color(camera.kind) ? 3 * pixels : 0);
  sample.depth_m.resize(uav::has_depth(camera.kind) ? pixels : 0);
  models_.resize(knows_pixels && (has_labels || !world_.anchors.empty()) ? pixels : 0);
  warn_of_blind_pixels(camera, r.sensor);
  place_instants(camera, r);
  raster::Picture picture;
  picture.rgb = sample.rgb;
  picture.depth_m = sample.depth_m;
  picture.entity = models_;
  draw(camera, r, picture);
  const std::uint64_t stream = random_stream(r.key.uav, r.key.sensor, "pixels");
  add_pixel_noise(camera.pixel_noise, {r.key.seed, stream, r.key.index, r.key.at}, sample.rgb);
  finish_depths(camera, r.key, sample.depth_m);
  if (has_labels) sample.labels = labels_of(models_, r.sensor);
  sample.knows_anchors = knows_pixels;
  sample.seen_anchors = find_anchors(world_, models_, lens.width_px);
  return sample;
}

// The samples of an antialiased picture lie beside the centres of its pixels, but depths and models
// are those of the centres: they are drawn in a second pass without antialiasing.
void ImageMaker::draw(const CameraModel& camera, const Request& r, raster::Picture picture) {
  raster::View view;
  view.camera = camera.intrinsics;
  view.near_m = near_m(camera);
  view.far_m = camera.far_m;
  view.instants = instants_;
  view.spacing_s = to_seconds(world_.step);
  view.exposure_s = camera.exposure_s;
  view.readout_s = camera.readout_s;
  view.hidden = r.uav;
  if (camera.antialias) {
    raster::Picture colors;
    colors.rgb = std::exchange(picture.rgb, {});
    view.antialias = true;
    renderer().draw(view, colors);
    view.antialias = false;
    if (picture.depth_m.empty() && picture.entity.empty()) return;
  }
  renderer().draw(view, picture);
}

// The steps that the shutter reaches back, and the image's own instant.
void ImageMaker::place_instants(const CameraModel& camera, const Request& r) {
  const std::size_t bodies = layout_.bodies() + parts_.size();
  const std::size_t steps = shutter_steps(camera, world_.step);
  poses_.resize((steps + 1) * bodies);
  instants_.clear();
  for (std::size_t i = 0; i <= steps; ++i) {
    const auto X_WB = std::span(poses_).subspan(i * bodies, bodies);
    for (std::size_t body = 0; body < layout_.bodies(); ++body) {
      X_WB[body] = layout_.past_pose_of(r.state, body, steps - i);
    }
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      // The camera's own UAV is hidden: its parts move nothing in the picture.
      const std::size_t ago = parts_[k].uav == r.uav ? 0 : steps - i;
      X_WB[layout_.bodies() + k] = layout_.past_pose_of(r.state, parts_[k].uav, ago) *
                                   layout_.turned_pose(r.state, world_, parts_[k], {}, ago);
    }
    const uav::Pose X_BC = layout_.mounting(r.state, world_, r.uav, r.sensor, steps - i) *
                           uav::Pose{{}, uav::q_body_from_optical()};
    instants_.push_back({X_WB[r.uav] * X_BC, X_WB});
  }
}

void ImageMaker::warn_of_blind_pixels(const CameraModel& camera, const Sensor& sensor) {
  if (!checked_.insert(&sensor).second || !camera.intrinsics.has_distortion()) return;
  const std::size_t blind = renderer().blind_pixels(camera.intrinsics);
  if (blind == 0) return;
  warn_({Consequence::kLooksDifferent,
         {},
         "camera '" + sensor.name + "'",
         "has " + std::to_string(blind) +
             " black pixels, because its distortion maps no direction to them; use "
             "coefficients that are valid for its whole field of view",
         true});
}

CameraRenderer& ImageMaker::renderer() {
  if (!renderer_) renderer_ = make_renderer_(helpers_);
  return *renderer_;
}

}  // namespace tether::sim
