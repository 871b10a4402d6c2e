#include <algorithm>
#include <cmath>

#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::tasks::testing {
namespace {

using uav::Vec3;

constexpr Duration kStep = std::chrono::milliseconds(1);
constexpr double kStep_s = 1e-3;
constexpr double kGravity_m_s2 = 9.81;
constexpr double kWall_m = 10.0;
constexpr Duration kImagePeriod = std::chrono::nanoseconds(33'333'333);
constexpr double kFloor_m_s2 = 1000.0;  // what stops it there
constexpr double kMaxYawAcceleration_rad_s2 = 6.0;

uav::Catalogue make_catalogue(const PlanarVehicle::Options& options) {
  uav::Catalogue catalogue;
  catalogue.uav = "uav";
  catalogue.sensors.push_back(
      {"camera",
       {{options.camera_ahead_m, 0, 0}, {}},
       30.0,
       uav::CameraProperties{uav::CameraModel::from_horizontal_fov(160, 120, rad_from_deg(80))}});
  catalogue.sensors.push_back(
      {"imu", {{}, options.q_BS_imu}, 1.0 / to_seconds(options.imu_period), uav::ImuProperties{}});
  catalogue.sensors.push_back({"range", {}, 0.0, uav::RangeProperties{0.0, 20.0}});
  const Vec3 size{0.5, 0.5, options.anchor_height_m};
  catalogue.anchors.push_back({"blue_box", uav::AnchorShape::kBox, size, {0.1, 0.2, 0.9}});
  catalogue.anchors.push_back({"grey_box", uav::AnchorShape::kBox, {1, 1, 1}, {0.5, 0.5, 0.5}});
  return catalogue;
}

Failure disconnected() {
  return {Failure::Kind::kDisconnected, "the connection to the coordinator ended"};
}

uav::Quat about_z(double yaw_rad) {
  return uav::from_axis_angle({0, 0, 1}, yaw_rad);
}

/// `of`, no further from `from` than `most`.
Vec3 towards(const Vec3& from, const Vec3& of, double most) {
  const Vec3 way = of - from;
  return norm(way) <= most ? of : from + (most / norm(way)) * way;
}

}  // namespace

PlanarVehicle::PlanarVehicle(const Options& options)
    : options_(options), catalogue_(make_catalogue(options)) {
  const double direction = options.start_yaw_rad + options.anchor_bearing_rad;
  const uav::Anchor& anchor = catalogue_.anchors.front();
  with_anchor_.boxes = {{rotate(about_z(direction), {options.anchor_distance_m, 0, 0}), direction,
                         anchor.size_m, anchor.color_rgb}};
  states_.push_back({{}, options.start_velocity_m_s, {}, options.start_yaw_rad, 0.0});
}

ExecTime PlanarVehicle::now() const {
  if (options_.clock_stands_still) return ExecTime();
  return ExecTime(
      duration_from_seconds(options_.clock_factor * to_seconds(now_.time_since_epoch())));
}

double PlanarVehicle::bearing() const {
  const Vec3 way = anchor_position() - position();
  return wrap_angle_rad(std::atan2(way.y, way.x) - yaw());
}

Status PlanarVehicle::begin_interaction(std::string_view sensor, std::string_view expected) {
  if (options_.disconnect_at && interactions_ >= *options_.disconnect_at) return disconnected();
  ++interactions_;
  if (sensor != expected) return Failure{Failure::Kind::kRefused, "no such sensor of this kind"};
  return ok_status();
}

PlanarVehicle::State PlanarVehicle::next(const State& state) const {
  State after = state;
  const double turn = kMaxYawAcceleration_rad_s2 * kStep_s;
  after.yaw_rate_rad_s += std::clamp(command_.yaw_rate_rad_s - state.yaw_rate_rad_s, -turn, turn);
  after.yaw_rad += after.yaw_rate_rad_s * kStep_s;
  const Vec3 wanted = rotate(about_z(state.yaw_rad), command_.velocity_H_m_s);
  after.v_W = towards(state.v_W, wanted, options_.max_acceleration_m_s2 * kStep_s);
  const bool is_on_floor = state.p_W.z <= -options_.height_m && state.v_W.z < 0.0;
  if (is_on_floor) after.v_W.z = std::min(0.0, state.v_W.z + kFloor_m_s2 * kStep_s);
  after.a_W = (1.0 / kStep_s) * (after.v_W - state.v_W);
  after.p_W = state.p_W + kStep_s * after.v_W;
  return after;
}

void PlanarVehicle::simulate_until(ExecTime until) {
  while (static_cast<Duration::rep>(states_.size()) <= until.time_since_epoch() / kStep) {
    states_.push_back(next(states_.back()));
  }
  now_ = std::max(now_, until);
}

const PlanarVehicle::State& PlanarVehicle::at(Duration since_start) const {
  return states_[static_cast<std::size_t>(since_start / kStep)];
}

Result<uav::Sample> PlanarVehicle::read_any(std::string_view sensor, uav::SensorKind kind,
                                            client::Read read) {
  if (const Status status = begin_interaction(sensor, uav::name(kind)); !status)
    return status.failure();
  if (kind == uav::SensorKind::kCamera) return uav::Sample(image());
  if (kind == uav::SensorKind::kImu) return uav::Sample(motion(read));
  return uav::Sample(range());
}

uav::CameraSample PlanarVehicle::image() {
  // The newest image that is there, or the next one to come.
  const Duration since_start = now_.time_since_epoch() - options_.image_delay;
  std::uint64_t index = 0;
  if (since_start > Duration::zero()) {
    index = static_cast<std::uint64_t>(since_start / kImagePeriod);
  }
  if (last_image_ && index <= *last_image_) index = *last_image_ + 1;
  last_image_ = index;
  const Duration sampled = static_cast<std::int64_t>(index) * kImagePeriod;
  simulate_until(std::max(now_, ExecTime(sampled + options_.image_delay)));

  const auto [hidden_from, hidden_until] = options_.anchor_hidden;
  const bool is_hidden = sampled >= hidden_from && sampled < hidden_until;
  const auto& scene = options_.anchor_is_there && !is_hidden ? with_anchor_ : without_anchor_;
  const auto& model = std::get<uav::CameraProperties>(catalogue_.sensors[0].properties).model;
  const State& state = at(sampled);
  const Vec3 p_WC = state.p_W + rotate(about_z(state.yaw_rad), {options_.camera_ahead_m, 0, 0});
  uav::CameraSample image =
      scene.render(model, vision::testing::level_camera(p_WC, state.yaw_rad), index);
  image.sampled_at = SimTime(sampled);
  ++images_read_;
  simulate_until(now_ + options_.compute_per_image);
  return image;
}

uav::ImuSample PlanarVehicle::motion(client::Read read) {
  auto index = static_cast<std::uint64_t>(now_.time_since_epoch() / options_.imu_period);
  if (read == client::Read::kNext && last_imu_ && index <= *last_imu_) index = *last_imu_ + 1;
  last_imu_ = index;
  const Duration sampled = static_cast<std::int64_t>(index) * options_.imu_period;
  simulate_until(std::max(now_, ExecTime(sampled)));

  const State& state = options_.imu_is_stuck ? states_.front() : at(sampled);
  uav::ImuSample reading;
  reading.sampled_at = options_.imu_instants_stand_still ? SimTime() : SimTime(sampled);
  reading.index = index;
  reading.q_WS = about_z(state.yaw_rad) * options_.q_BS_imu;
  const uav::Quat q_SW = inverse(reading.q_WS);
  reading.specific_force_m_s2 =
      rotate(q_SW, state.a_W + Vec3{0, 0, kGravity_m_s2}) + options_.imu_bias_m_s2;
  reading.angular_velocity_rad_s = rotate(q_SW, {0, 0, state.yaw_rate_rad_s});
  return reading;
}

uav::RangeSample PlanarVehicle::range() {
  uav::RangeSample reading;
  reading.sampled_at = SimTime(now_.time_since_epoch());
  reading.index = ranges_read_++;
  const double ahead = std::cos(yaw());
  if (ahead > 0.0) reading.range_m = (kWall_m - position().x) / ahead;
  simulate_until(now_ + options_.range_delays[reading.index % options_.range_delays.size()]);
  return reading;
}

Result<uav::BatterySample> PlanarVehicle::read_battery() {
  if (!options_.endurance) return Vehicle::read_battery();
  if (const Status status = begin_interaction(); !status) return status.failure();
  const Duration since_start = now_.time_since_epoch();
  return uav::BatterySample{
      .sampled_at = SimTime(since_start),
      .voltage_V = 12.0,
      .current_A = 6.0,
      .charge = std::max(0.0, 1.0 - to_seconds(since_start) / to_seconds(*options_.endurance))};
}

Status PlanarVehicle::command_velocity(const uav::VelocityCommand& command) {
  if (Status status = begin_interaction(); !status) return status;
  command_ = command;
  commands_.push_back(command);
  return ok_status();
}

Status PlanarVehicle::sleep_for(Duration duration) {
  return sleep_until(now_ + duration);
}

Status PlanarVehicle::sleep_until(ExecTime until) {
  if (Status status = begin_interaction(); !status) return status;
  simulate_until(until);
  return ok_status();
}

Status PlanarVehicle::annotate(std::string_view topic, std::string_view json) {
  annotations_.push_back({std::string(topic), std::string(json)});
  return ok_status();
}

Status PlanarVehicle::finish(bool reached_goal, std::string_view outcome,
                             std::string_view details_json) {
  if (Status status = begin_interaction(); !status) return status;
  finish_ = Finish{reached_goal, std::string(outcome), std::string(details_json)};
  return ok_status();
}

}  // namespace tether::tasks::testing
