#include <algorithm>
#include <cmath>

#include <tether/tasks/testing/turning_vehicle.h>

namespace tether::tasks::testing {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(1);
constexpr double kStep_s = 1e-3;

const uav::Anchor kAnchor{"blue_box", uav::AnchorShape::kBox, {0.5, 0.5, 0.5}, {0.1, 0.2, 0.9}};

uav::Catalogue make_catalogue() {
  uav::Catalogue catalogue;
  catalogue.uav = "uav";
  catalogue.sensors.push_back(
      {"camera",
       {},
       30.0,
       uav::CameraProperties{uav::CameraModel::from_horizontal_fov(160, 120, rad_from_deg(80))}});
  catalogue.sensors.push_back({"imu", {}, 200.0, uav::ImuProperties{}});
  catalogue.anchors.push_back(kAnchor);
  catalogue.anchors.push_back({"grey_box", uav::AnchorShape::kBox, {1, 1, 1}, {0.5, 0.5, 0.5}});
  return catalogue;
}

Failure disconnected() {
  return {Failure::Kind::kDisconnected, "the connection to the coordinator ended"};
}

std::size_t to_ms(Duration d) {
  return static_cast<std::size_t>(d / kStep);
}

}  // namespace

TurningVehicle::TurningVehicle(const Options& options)
    : options_(options), catalogue_(make_catalogue()) {
  const double bearing = options.anchor_bearing_rad;
  const double distance = options.anchor_distance_m;
  with_anchor_.boxes = {{{distance * std::cos(bearing), distance * std::sin(bearing), 0},
                         bearing,
                         kAnchor.size_m,
                         kAnchor.color_rgb}};
}

Status TurningVehicle::begin_interaction() {
  if (options_.disconnect_at && interactions_ >= *options_.disconnect_at) {
    return disconnected();
  }
  ++interactions_;
  return ok_status();
}

/// The yaw follows the commanded rate with limited acceleration.
void TurningVehicle::simulate_until(ExecTime until) {
  while (yaw_at_ms_.size() <= to_ms(until.time_since_epoch())) {
    const double change = options_.max_yaw_acceleration_rad_s2 * kStep_s;
    yaw_rate_rad_s_ += std::clamp(command_.yaw_rate_rad_s - yaw_rate_rad_s_, -change, change);
    yaw_at_ms_.push_back(yaw_at_ms_.back() + yaw_rate_rad_s_ * kStep_s);
  }
  now_ = std::max(now_, until);
}

Result<uav::CameraSample> TurningVehicle::read_camera(std::string_view sensor, client::Read) {
  if (const Status status = begin_interaction(); !status) {
    return status.failure();
  }
  if (sensor != "camera") {
    return Failure{Failure::Kind::kRefused, "no such camera"};
  }
  // The newest image that is there, or the next one to come.
  const Duration since_start = now_.time_since_epoch() - options_.image_delay;
  std::uint64_t index = 0;
  if (since_start > Duration::zero()) {
    index = static_cast<std::uint64_t>(since_start / options_.image_period);
  }
  if (last_image_ && index <= *last_image_) {
    index = *last_image_ + 1;
  }
  last_image_ = index;
  const Duration sampled = static_cast<std::int64_t>(index) * options_.image_period;
  simulate_until(std::max(now_, ExecTime(sampled + options_.image_delay)));

  const auto [hidden_from, hidden_until] = options_.anchor_hidden;
  const bool is_hidden = sampled >= hidden_from && sampled < hidden_until;
  const auto& scene = options_.anchor_is_there && !is_hidden ? with_anchor_ : without_anchor_;
  const auto& model = std::get<uav::CameraProperties>(catalogue_.sensors[0].properties).model;
  uav::CameraSample image =
      scene.render(model, vision::testing::level_camera({}, yaw_at_ms_[to_ms(sampled)]), index);
  image.sampled_at = SimTime(sampled);
  ++images_read_;
  simulate_until(now_ + options_.compute_per_image);
  return image;
}

Result<uav::ImuSample> TurningVehicle::read_imu(std::string_view, client::Read) {
  return Failure{Failure::Kind::kRefused, "this vehicle has no IMU"};
}

Result<uav::RangeSample> TurningVehicle::read_range(std::string_view, client::Read) {
  return Failure{Failure::Kind::kRefused, "this vehicle has no rangefinder"};
}

Status TurningVehicle::command_velocity(const uav::VelocityCommand& command) {
  if (Status status = begin_interaction(); !status) {
    return status;
  }
  command_ = command;
  commands_.push_back(command);
  return ok_status();
}

Status TurningVehicle::sleep_for(Duration duration) {
  return sleep_until(now_ + duration);
}

Status TurningVehicle::sleep_until(ExecTime until) {
  if (Status status = begin_interaction(); !status) {
    return status;
  }
  simulate_until(until);
  return ok_status();
}

Status TurningVehicle::annotate(std::string_view topic, std::string_view json) {
  annotations_.push_back({std::string(topic), std::string(json)});
  return ok_status();
}

Status TurningVehicle::finish(bool reached_goal, std::string_view outcome,
                              std::string_view details_json) {
  if (Status status = begin_interaction(); !status) {
    return status;
  }
  finish_ = Finish{reached_goal, std::string(outcome), std::string(details_json)};
  return ok_status();
}

}  // namespace tether::tasks::testing
