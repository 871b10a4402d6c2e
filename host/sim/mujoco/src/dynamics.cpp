#include "dynamics.h"

#include "conversions.h"
#include "physics_model.h"

#include <string>

#include <tether/base/error.h>

namespace tether::sim {

Dynamics::Dynamics(const World& world, const WarningSink& warn)
    : world_(world),
      model_(make_physics_model(world, warn)),
      data_(make_data(*model_)),
      recorder_(world),
      X_WB_(recorder_.layout().bodies()),
      motions_(recorder_.layout().uavs()) {
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
  read_engine();
  recorder_.reset(X_WB_);
}

void Dynamics::set_command(std::size_t uav, const uav::VelocityCommand& command) {
  flights_[uav].command = command;
}

void Dynamics::step() {
  recorder_.begin_step(X_WB_);
  for (std::size_t i = 0; i < flights_.size(); ++i) apply_rotors(i);
  mj_step(model_.get(), data_.get());
  check_engine();
  read_engine();
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

// The engine resets a world when its state becomes unusable. A run must not continue then.
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
void Dynamics::read_engine() {
  for (std::size_t i = 0; i < X_WB_.size(); ++i) {
    X_WB_[i] = pose_from(data_->qpos + qpos_address(i));
  }
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const mjtNum* qacc = data_->qacc + qvel_address(i);
    motions_[i] = {vec3_from(data_->qvel + qvel_address(i) + 3), vec3_from(qacc),
                   vec3_from(qacc + 3)};
  }
}

void Dynamics::capture(std::vector<double>& state) const {
  recorder_.capture(X_WB_, motions_, state);
}

}  // namespace tether::sim
