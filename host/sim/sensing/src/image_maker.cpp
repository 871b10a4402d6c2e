// Makes an image from views: the instants of the shutter are drawn (`draw`), as many as the motion
// in the picture requires (`motion_px`), and their rows are mixed by weight (`mix`). A lens is
// applied to each view by ImageWarp; pixel noise is added last.

#include "image_maker.h"

#include "sensor_noise.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <tether/sim_sensing/sensor_suite.h>

namespace tether::sim {
namespace {

std::size_t bytes_of(const uav::CameraModel& camera) {
  return std::size_t{3} * static_cast<std::size_t>(camera.width_px) *
         static_cast<std::size_t>(camera.height_px);
}

}  // namespace

ViewSize largest_view(const World& world) {
  ViewSize size;
  for (const Uav& uav : world.uavs) {
    for (const Sensor& sensor : uav.sensors) {
      const auto* camera = std::get_if<CameraModel>(&sensor.model);
      if (!camera) continue;
      const uav::CameraModel rendered = ImageMaker::rendered_camera(camera->intrinsics);
      size.width_px = std::max(size.width_px, rendered.width_px);
      size.height_px = std::max(size.height_px, rendered.height_px);
    }
  }
  return size;
}

uav::CameraModel ImageMaker::rendered_camera(const uav::CameraModel& camera) {
  return Plan(camera).rendered;
}

ImageMaker::Plan::Plan(const uav::CameraModel& camera) : rendered(camera) {
  if (!ImageWarp::is_needed(camera)) return;
  warp.emplace(camera);
  rendered = warp->source();
}

ImageMaker::ImageMaker(const World& world, std::vector<double> body_radii_m,
                       ViewRendererFactory make_renderer, const WarningSink& warn)
    : world_(world),
      layout_(world),
      body_radii_m_(std::move(body_radii_m)),
      make_renderer_(std::move(make_renderer)),
      warn_(warn),
      poses_(layout_.bodies()) {
  assert(body_radii_m_.size() == layout_.bodies());
}

uav::CameraSample ImageMaker::make(const CameraModel& camera, const Request& r) {
  uav::CameraSample sample{r.key.at, r.key.index, camera.intrinsics.width_px,
                           camera.intrinsics.height_px,
                           std::vector<std::uint8_t>(bytes_of(camera.intrinsics))};
  draw(camera, r, 0.0, {0, camera.intrinsics.height_px}, sample.rgb);
  if (Shutter(camera).window_s() > 0.0) {
    const int instants = count_instants(motion_px(camera, r));
    if (instants > 1) mix(camera, r, instants, sample.rgb);
  }
  const std::uint64_t stream = random_stream(r.key.uav, r.key.sensor, "pixels");
  add_pixel_noise(camera.pixel_noise, {r.key.seed, stream, r.key.index, r.key.at}, sample.rgb);
  return sample;
}

// Rows of the image of one instant, through the lens, to where they are in `rgb`. @pre all rows for
// a camera with a warp.
void ImageMaker::draw(const CameraModel& camera, const Request& r, double steps_ago,
                      const Rows& rows, Bytes rgb) {
  const Plan& plan = plan_of(r.sensor, camera);
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    poses_[i] = layout_.past_pose_of(r.state, i, steps_ago);
  }
  View view{plan.rendered, camera.near_m, camera.far_m, poses_[r.uav] * r.sensor.X_BS,
            poses_,        r.uav};
  view.with_depth = steps_ago == 0.0 && Shutter(camera).window_s() > 0.0;
  if (plan.warp) {
    ideal_rgb_.resize(bytes_of(plan.rendered));
    renderer().render(view, ideal_rgb_);
    plan.warp->apply(ideal_rgb_, rgb);
    return;
  }
  view.camera.height_px = rows.count;
  view.camera.cy_px -= rows.first;
  const std::size_t stride = 3 * static_cast<std::size_t>(camera.intrinsics.width_px);
  renderer().render(
      view, rgb.subspan(stride * static_cast<std::size_t>(rows.first), bytes_of(view.camera)));
}

// How far things move in the picture within the shutter's window, were they as fast throughout as
// in its fastest step: instants are evenly spaced. The last instant's image tells how near things
// are.
double ImageMaker::motion_px(const CameraModel& camera, const Request& r) {
  const double steps = steps_of(Shutter(camera).window_s());
  const double nearest_m = renderer().nearest_depth_m();
  double fastest_px = 0.0;
  for (double ago = 0.0; ago < steps; ago += 1.0) {
    fastest_px = std::max(fastest_px, step_motion_px(camera, r, ago, nearest_m));
  }
  return steps * fastest_px;
}

double ImageMaker::step_motion_px(const CameraModel& camera, const Request& r, double steps_ago,
                                  double nearest_m) {
  const double focal_px = plan_of(r.sensor, camera).rendered.fx_px;
  const Movement carrier = movement_of(r, r.uav, steps_ago);
  const Movement eye{carrier.before * r.sensor.X_BS, carrier.after * r.sensor.X_BS};
  double of_bodies_px = 0.0;
  for (std::size_t i = 0; i < body_radii_m_.size(); ++i) {
    if (i == r.uav) continue;
    of_bodies_px =
        std::max(of_bodies_px, body_motion_px(movement_of(r, i, steps_ago), body_radii_m_[i],
                                              eye.after.p, camera.near_m, focal_px));
  }
  return camera_motion_px(eye, nearest_m, focal_px) + of_bodies_px;
}

Movement ImageMaker::movement_of(const Request& r, std::size_t body, double steps_ago) const {
  return {layout_.past_pose_of(r.state, body, steps_ago + 1.0),
          layout_.past_pose_of(r.state, body, steps_ago)};
}

// `rgb` is the image of the last instant, and becomes the mix.
void ImageMaker::mix(const CameraModel& camera, const Request& r, int instants, Bytes rgb) {
  const Shutter shutter(camera);
  const double steps = steps_of(shutter.window_s());
  light_.clear(rgb.size());
  instant_rgb_.resize(rgb.size());
  for (int i = 0; i + 1 < instants; ++i) {
    draw(camera, r, steps * (instants - 1 - i) / (instants - 1),
         exposed_rows(camera, r, i, instants), instant_rgb_);
    add_rows(shutter, i, instants, instant_rgb_);
  }
  add_rows(shutter, instants - 1, instants, rgb);
  light_.encode(rgb);
}

// The rows that an instant's light reaches: what else need not be drawn. Any row of a warped image
// may come from any row of what is drawn.
ImageMaker::Rows ImageMaker::exposed_rows(const CameraModel& camera, const Request& r, int instant,
                                          int instants) {
  const Shutter shutter(camera);
  Rows rows{0, shutter.rows};
  if (plan_of(r.sensor, camera).warp) return rows;
  const auto is_dark = [&](int row) { return row_weight(shutter, row, instant, instants) == 0.0; };
  while (rows.count > 1 && is_dark(rows.first)) ++rows.first, --rows.count;
  while (rows.count > 1 && is_dark(rows.first + rows.count - 1)) --rows.count;
  return rows;
}

void ImageMaker::add_rows(const Shutter& shutter, int instant, int instants, Bytes rgb) {
  const std::size_t stride = rgb.size() / static_cast<std::size_t>(shutter.rows);
  for (int row = 0; row < shutter.rows; ++row) {
    const double weight = row_weight(shutter, row, instant, instants);
    if (weight == 0.0) continue;
    const std::size_t first = static_cast<std::size_t>(row) * stride;
    light_.add(first, rgb.subspan(first, stride), weight);
  }
}

const ImageMaker::Plan& ImageMaker::plan_of(const Sensor& sensor, const CameraModel& camera) {
  const auto known = plans_.find(&sensor);
  if (known != plans_.end()) return known->second;
  const Plan& plan = plans_.try_emplace(&sensor, camera.intrinsics).first->second;
  if (const std::size_t blind = plan.warp ? plan.warp->blind_pixels() : 0; blind > 0) {
    warn_({Consequence::kLooksDifferent,
           {},
           "camera '" + sensor.name + "'",
           "has " + std::to_string(blind) +
               " black pixels, because its distortion maps no direction to them; use "
               "coefficients that are valid for its whole field of view"});
  }
  return plan;
}

// Made at the first image, large enough for every camera of the world.
ViewRenderer& ImageMaker::renderer() {
  if (renderer_) return *renderer_;
  const ViewSize size = largest_view(world_);
  renderer_ = make_renderer_(size.width_px, size.height_px);
  return *renderer_;
}

}  // namespace tether::sim
