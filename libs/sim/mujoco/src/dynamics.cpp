#include "dynamics.h"

#include "conversions.h"
#include "physics_model.h"
#include "shutter.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

constexpr std::size_t kPoseSize = 7;
constexpr std::size_t kMotionSize = 9;

constexpr double kLongestWindow_s = 1.0;

double checked_window_s(const Uav& uav, const Sensor& sensor, const CameraModel& camera) {
  const double window_s = Shutter(camera).window_s();
  if (camera.exposure_s >= 0.0 && camera.readout_s >= 0.0 && window_s <= kLongestWindow_s) {
    return window_s;
  }
  throw Error(ErrorCode::kBadFile, "camera '" + sensor.name + "' of UAV '" + uav.name +
                                       "': exposure and readout must not be negative, and take at "
                                       "most 1 s together");
}

// How many steps the shutter of any camera reaches back.
std::size_t shutter_steps(const World& world) {
  double longest_s = 0.0;
  for (const Uav& uav : world.uavs) {
    for (const Sensor& sensor : uav.sensors) {
      const auto* camera = std::get_if<CameraModel>(&sensor.model);
      if (camera) longest_s = std::max(longest_s, checked_window_s(uav, sensor, *camera));
    }
  }
  return static_cast<std::size_t>(std::ceil(longest_s / to_seconds(world.step)));
}

// Between two poses that are near each other, `share` of the way.
uav::Pose between(const uav::Pose& a, const uav::Pose& b, double share) {
  const auto mix = [&](double x, double y) { return x + share * (y - x); };
  // A quaternion and its opposite are the same rotation.
  const double sign = a.q.w * b.q.w + a.q.x * b.q.x + a.q.y * b.q.y + a.q.z * b.q.z < 0 ? -1 : 1;
  return {a.p + share * (b.p - a.p),
          uav::normalized({mix(a.q.w, sign * b.q.w), mix(a.q.x, sign * b.q.x),
                           mix(a.q.y, sign * b.q.y), mix(a.q.z, sign * b.q.z)})};
}

}  // namespace

Dynamics::Dynamics(const World& world, const WarningSink& warn)
    : world_(world),
      bodies_(moving_bodies(world).size()),
      model_(make_physics_model(world, warn)),
      data_(make_data(*model_)),
      past_(shutter_steps(world), bodies_ * kPoseSize) {
  for (const Uav& uav : world.uavs) flights_.push_back({&uav.airframe, {}, {}});
  reset();
}

void Dynamics::reset() {
  mj_resetData(model_.get(), data_.get());
  for (std::size_t i = 0; i < flights_.size(); ++i) {
    Flight& flight = flights_[i];
    flight.command = {};
    flight.state =
        uav::hover_state(*flight.airframe, world_.gravity_m_s2, yaw_rad(world_.uavs[i].X_WB.q));
  }
  past_.fill(poses());
}

void Dynamics::set_command(std::size_t uav, const uav::VelocityCommand& command) {
  flights_[uav].command = command;
}

void Dynamics::step() {
  past_.push(poses());
  for (std::size_t i = 0; i < flights_.size(); ++i) apply_rotors(i);
  mj_step(model_.get(), data_.get());
  check_engine();
}

void Dynamics::apply_rotors(std::size_t uav) {
  Flight& flight = flights_[uav];
  const uav::BodyState body = body_state(uav);
  const uav::Wrench wrench = uav::step(*flight.airframe, world_.gravity_m_s2, body, flight.command,
                                       world_.step, flight.state);
  mjtNum* out = data_->xfrc_applied + 6 * engine_body(uav);
  copy_to(rotate(body.q_WB, wrench.force_B), out);
  copy_to(rotate(body.q_WB, wrench.torque_B), out + 3);
}

// The engine restarts a world by itself when its state becomes unusable; a run must not go on so.
void Dynamics::check_engine() const {
  const mjWarningStat* warnings = data_->warning;
  const int bad = warnings[mjWARN_BADQPOS].number + warnings[mjWARN_BADQVEL].number +
                  warnings[mjWARN_BADQACC].number;
  if (bad == 0) return;
  throw Error(ErrorCode::kSetup,
              "the simulated motion became unstable: check masses and inertias, or use a shorter "
              "step than " +
                  std::to_string(to_seconds(world_.step)) + " s");
}

bool Dynamics::contacts_dropped() const {
  return data_->warning[mjWARN_CONTACTFULL].number + data_->warning[mjWARN_CNSTRFULL].number > 0;
}

uav::BodyState Dynamics::body_state(std::size_t uav) const {
  const mjtNum* qpos = data_->qpos + qpos_address(uav);
  const mjtNum* qvel = data_->qvel + qvel_address(uav);
  return {vec3_from(qpos), quat_from(qpos + 3), vec3_from(qvel), vec3_from(qvel + 3)};
}

std::span<const double> Dynamics::poses() const {
  return {data_->qpos, bodies_ * kPoseSize};
}

// A free joint's velocities are linear in W, angular in B; so are its accelerations.
void Dynamics::capture(std::vector<double>& state) const {
  const std::size_t now = bodies_ * kPoseSize + flights_.size() * kMotionSize;
  state.resize(now + past_.size());
  auto out = std::copy_n(data_->qpos, bodies_ * kPoseSize, state.begin());
  for (std::size_t i = 0; i < flights_.size(); ++i) {
    out = std::copy_n(data_->qvel + qvel_address(i) + 3, 3, out);
    out = std::copy_n(data_->qacc + qvel_address(i), 6, out);
  }
  past_.write(state.data() + now);
}

uav::Pose Dynamics::pose_of(const std::vector<double>& state, std::size_t body) {
  return pose_from(state.data() + body * kPoseSize);
}

BodyMotion Dynamics::motion_of(const std::vector<double>& state, std::size_t uav) const {
  const double* motion = state.data() + bodies_ * kPoseSize + uav * kMotionSize;
  return {vec3_from(motion), vec3_from(motion + 3), vec3_from(motion + 6)};
}

uav::Pose Dynamics::past_pose_of(const std::vector<double>& state, std::size_t body,
                                 double steps_ago) const {
  // The pose at a whole number of steps before the capture.
  const auto pose = [&](std::size_t steps) {
    if (steps == 0) return pose_of(state, body);
    const std::size_t row = past_.instants() - std::min(steps, past_.instants());
    const double* rows = state.data() + state.size() - past_.size();
    return pose_from(rows + (row * bodies_ + body) * kPoseSize);
  };
  const auto whole = static_cast<std::size_t>(steps_ago);
  const double share = steps_ago - static_cast<double>(whole);
  return share == 0.0 ? pose(whole) : between(pose(whole), pose(whole + 1), share);
}

}  // namespace tether::sim
