#include "dynamics.h"

#include "conversions.h"
#include "physics_model.h"

#include <algorithm>
#include <string>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

constexpr std::size_t kPoseSize = 7;
constexpr std::size_t kMotionSize = 9;

}  // namespace

Dynamics::Dynamics(const World& world, const WarningSink& warn)
    : world_(world),
      bodies_(moving_bodies(world).size()),
      model_(make_physics_model(world, warn)),
      data_(make_data(*model_)) {
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
}

void Dynamics::set_command(std::size_t uav, const uav::VelocityCommand& command) {
  flights_[uav].command = command;
}

void Dynamics::step() {
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

// A free joint's velocities are linear in W, angular in B; so are its accelerations.
void Dynamics::capture(std::vector<double>& state) const {
  state.resize(bodies_ * kPoseSize + flights_.size() * kMotionSize);
  auto out = std::copy_n(data_->qpos, bodies_ * kPoseSize, state.begin());
  for (std::size_t i = 0; i < flights_.size(); ++i) {
    out = std::copy_n(data_->qvel + qvel_address(i) + 3, 3, out);
    out = std::copy_n(data_->qacc + qvel_address(i), 6, out);
  }
}

uav::Pose Dynamics::pose_of(const std::vector<double>& state, std::size_t body) {
  return pose_from(state.data() + body * kPoseSize);
}

BodyMotion Dynamics::motion_of(const std::vector<double>& state, std::size_t uav) const {
  const double* motion = state.data() + bodies_ * kPoseSize + uav * kMotionSize;
  return {vec3_from(motion), vec3_from(motion + 3), vec3_from(motion + 6)};
}

}  // namespace tether::sim
