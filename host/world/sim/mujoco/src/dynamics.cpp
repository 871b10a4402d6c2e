#include "dynamics.h"

#include "conversions.h"
#include "physics_model.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

Error unstable(Duration step) {
  return {ErrorCode::kSetup,
          "the simulated motion became unstable: check masses and inertias, or use a shorter step "
          "than " +
              std::to_string(to_seconds(step)) + " s"};
}

// Half of how thick one of the engine's shapes is where it is thinnest.
double half_thickness_m(const mjModel& model, int geom) {
  const mjtNum* const size = model.geom_size + 3 * geom;
  switch (model.geom_type[geom]) {
    case mjGEOM_SPHERE:
    case mjGEOM_CAPSULE:
      return size[0];
    case mjGEOM_CYLINDER:
      return std::min(size[0], size[1]);
    default:  // half of the lengths of a box, an ellipsoid or a mesh
      return std::min({size[0], size[1], size[2]});
  }
}

}  // namespace

Dynamics::Dynamics(const World& world, const WarningSink& warn, const MeshFiles& meshes)
    : world_(world),
      model_(make_physics_model(world, warn, meshes)),
      data_(make_data(*model_)),
      recorder_(world),
      X_WB_(recorder_.layout().bodies()),
      motions_(recorder_.layout().uavs()),
      shapes_(shapes_of(world)),
      qvel_before_(static_cast<std::size_t>(model_->nv)),
      meter_(world, [&](const MeshGeometry& mesh) { return meshes.corners(mesh); }) {
  meter_.warn_of_starts(warn);
  for (const Uav& uav : world.uavs)
    flights_.push_back({{uav.airframe, world.gravity_m_s2, world.step},
                        {},
                        {},
                        uav::Gusts(world.wind, world.step, 0, uav.name)});
  const std::vector<MovingBody> bodies = moving_bodies(world);
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].model && bodies[i].model->path) driven_.emplace_back(i, bodies[i]);
  for (int geom = 0; geom < model_->ngeom; ++geom) {
    const int uav = model_->geom_bodyid[geom] - engine_body(0);
    if (uav < 0 || uav >= static_cast<int>(flights_.size())) continue;
    double& thickest_m = flights_[static_cast<std::size_t>(uav)].half_thickness_m;
    thickest_m = std::max(thickest_m, half_thickness_m(*model_, geom));
  }
  reset(0);
}

void Dynamics::reset(std::uint64_t seed) {
  mj_resetData(model_.get(), data_.get());
  for (std::size_t i = 0; i < flights_.size(); ++i) {
    Flight& flight = flights_[i];
    const Uav& uav = world_.uavs[i];
    flight.setpoint = {};
    flight.state = uav::hover_state(uav.airframe, world_.gravity_m_s2, yaw_rad(uav.X_WB.q),
                                    mean_wind_W(world_.wind, uav.X_WB.p.z));
    flight.gusts = uav::Gusts(world_.wind, world_.step, seed, uav.name);
    if (uav.energy) flight.meter.emplace(*uav.energy, uav.airframe, world_.gravity_m_s2);
  }
  now_ = SimTime{};
  for (std::size_t i = 0; i < flights_.size(); ++i) carry(i);
  place_driven(now_);
  read_engine();
  recorder_.reset(X_WB_);
  contacts_.reset();
}

void Dynamics::set_setpoint(std::size_t uav, const uav::Setpoint& setpoint) {
  if (setpoint.has(uav::kJoints)) recorder_.joints().command(uav, setpoint.joints_rad);
  if (setpoint.flies()) flights_[uav].setpoint = setpoint;
}

void Dynamics::step() {
  recorder_.begin_step(X_WB_);
  for (std::size_t i = 0; i < flights_.size(); ++i) carry(i);
  for (std::size_t i = 0; i < flights_.size(); ++i) fly(i);
  const std::int64_t parts = parts_of_step();
  model_->opt.timestep = to_seconds(world_.step) / static_cast<double>(parts);
  const SimTime end = now_ + world_.step;
  for (std::int64_t part = 0; part < parts; ++part)
    step_engine(now_ + world_.step * part / parts, now_ + world_.step * (part + 1) / parts,
                part == 0 ? now_ : end);
  now_ = end;
}

// In one part, no UAV may move by more than half its thickness: it would pass what it should meet,
// or be pushed out at the far side.
std::int64_t Dynamics::parts_of_step() const {
  double driven_m = 0.0;
  for (const auto& [i, body] : driven_)
    driven_m =
        std::max(driven_m, uav::norm(driven_state(body, now_ + world_.step).X_WB.p - X_WB_[i].p));
  double parts = 1.0;
  for (std::size_t i = 0; i < flights_.size(); ++i) {
    if (flights_[i].half_thickness_m <= 0.0) continue;  // it meets nothing
    const double own_m = uav::norm(motions_[i].v_WB_W) * to_seconds(world_.step);
    parts = std::max(parts, std::ceil((own_m + driven_m) / flights_[i].half_thickness_m));
  }
  constexpr double kMostParts = 100'000.0;
  if (parts <= kMostParts) return static_cast<std::int64_t>(parts);
  throw unstable(world_.step);
}

// @param seen_at the boundary of steps that contacts of this part belong to
void Dynamics::step_engine(SimTime from, SimTime until, SimTime seen_at) {
  std::copy_n(data_->qvel, qvel_before_.size(), qvel_before_.begin());
  mj_step1(model_.get(), data_.get());
  for (std::size_t i = 0; i < flights_.size(); ++i) apply_rotors(i);
  drive(from);
  mj_step2(model_.get(), data_.get());
  check_engine();
  log_contacts(seen_at);
  place_driven(until);
  read_engine();
}

// Puts driven bodies where they are at a time, with their velocities, so that what stands on them
// is carried along.
void Dynamics::place_driven(SimTime at) {
  for (const auto& [i, body] : driven_) {
    const DrivenState state = driven_state(body, at);
    mjtNum* qvel = data_->qvel + qvel_address(i);
    copy_to(state.X_WB, data_->qpos + qpos_address(i));
    copy_to(state.v_WB, qvel);
    copy_to(rotate(inverse(state.X_WB.q), state.w_WB_W), qvel + 3);
  }
}

// The forces that make the engine accelerate driven bodies as they do from then on: whatever
// touches them is pushed by their true motion.
void Dynamics::drive(SimTime from) {
  for (const auto& [i, body] : driven_) {
    const DrivenState state = driven_state(body, from);
    mjtNum* force = data_->qfrc_applied + qvel_address(i);
    copy_to(kDrivenMass_kg * (state.a_WB + felt_at_rest(world_)), force);
    copy_to(kDrivenMass_kg * rotate(inverse(state.X_WB.q), state.alpha_WB_W), force + 3);
  }
}

// The engine has found the contacts at the beginning of its step, where X_WB_ still is. Its solver
// has acted since, so that the speed of an impact is that of before.
void Dynamics::log_contacts(SimTime seen_at) {
  const auto uavs = static_cast<int>(flights_.size());
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    const int shapes[] = {contact.geom1, contact.geom2};
    const int bodies[] = {model_->geom_bodyid[contact.geom1], model_->geom_bodyid[contact.geom2]};
    const uav::Vec3 p_W = vec3_from(contact.pos);
    const uav::Vec3 apart = velocity_before(bodies[1], p_W) - velocity_before(bodies[0], p_W);
    const double speed_m_s = -dot(vec3_from(contact.frame), apart);
    for (const int own : {0, 1}) {
      const int uav = bodies[own] - engine_body(0);
      if (uav < 0 || uav >= uavs) continue;
      const int other = shapes[1 - own];
      contacts_.add({seen_at, static_cast<std::size_t>(uav),
                     shapes_[static_cast<std::size_t>(other)].owner, other, speed_m_s});
    }
  }
}

// Of the point of a body that is at p_W, at the beginning of the step.
uav::Vec3 Dynamics::velocity_before(int engine_body, const uav::Vec3& p_W) const {
  if (engine_body == 0) return {};
  const auto body = static_cast<std::size_t>(engine_body - 1);
  const mjtNum* qvel = qvel_before_.data() + qvel_address(body);
  const uav::Pose& X_WB = X_WB_[body];
  return vec3_from(qvel) + cross(rotate(X_WB.q, vec3_from(qvel + 3)), p_W - X_WB.p);
}

// What the UAV carries in the step that begins now.
void Dynamics::carry(std::size_t uav) {
  double load_kg = 0.0;
  for (const Payload& payload : world_.uavs[uav].payloads)
    if (payload.from <= now_ && now_ < payload.until) load_kg += payload.mass_kg;
  if (load_kg == flights_[uav].load_kg) return;
  flights_[uav].load_kg = load_kg;
  model_->body_mass[engine_body(uav)] = world_.uavs[uav].airframe.mass_kg + load_kg;
  if (!scratch_) scratch_ = make_data(*model_);
  mj_setConst(model_.get(), scratch_.get());
}

// The controller and the rotors.
void Dynamics::fly(std::size_t uav) {
  Flight& flight = flights_[uav];
  const uav::BodyState body = body_state(uav);
  if (flight.meter)
    flight.multirotor.limit_rotor_speed(world_.uavs[uav].airframe.max_rotor_speed_rad_s *
                                        flight.meter->speed_limit());
  const uav::Vec3 v_WA = flight.gusts.step(body.p_WB.z, body.v_WB);
  const uav::Wrench wrench = flight.multirotor.step(body, flight.setpoint, flight.state, v_WA);
  if (flight.meter) {
    uav::BodyState in_air = body;
    in_air.v_WB = body.v_WB - v_WA;
    flight.meter->step(now_, world_.step, in_air, flight.state);
  }
  flight.force_W = rotate(body.q_WB, wrench.force_B);
  flight.torque_W = rotate(body.q_WB, wrench.torque_B);
}

// Adds a force on the centre of mass and a torque, as the engine adds xfrc_applied, to the bit. But
// for each body, the engine makes the whole columns of a Jacobian that is 0 except for this body's
// joint: the steps of a fleet would take a time that grows with its square. Between the engine's
// two halves, passive forces are 0: none are enabled.
void Dynamics::apply_rotors(std::size_t uav) {
  const int body = engine_body(uav), joint = qvel_address(uav);
  const uav::Vec3 from_com =
      vec3_from(data_->xipos + 3 * body) - vec3_from(data_->subtree_com + 3 * body);
  const Flight& flight = flights_[uav];
  for (int i = joint; i < joint + 6; ++i) {
    const uav::Vec3 turning = vec3_from(data_->cdof + 6 * i);
    const uav::Vec3 moving = vec3_from(data_->cdof + 6 * i + 3) + cross(turning, from_com);
    data_->qfrc_passive[i] = dot(moving, flight.force_W);
    data_->qfrc_applied[i] = dot(turning, flight.torque_W);
  }
}

// The engine resets a world when its state becomes unusable. A run must not continue then.
void Dynamics::check_engine() const {
  const mjWarningStat* warnings = data_->warning;
  const int bad = warnings[mjWARN_BADQPOS].number + warnings[mjWARN_BADQVEL].number +
                  warnings[mjWARN_BADQACC].number;
  if (bad > 0) throw unstable(world_.step);
}

bool Dynamics::contacts_dropped() const {
  return data_->warning[mjWARN_CONTACTFULL].number + data_->warning[mjWARN_CNSTRFULL].number > 0;
}

std::optional<energy::Status> Dynamics::battery(std::size_t uav) const {
  if (!flights_[uav].meter) return std::nullopt;
  return flights_[uav].meter->status();
}

void Dynamics::computing(std::size_t uav, double cores) {
  if (flights_[uav].meter) flights_[uav].meter->computing(cores);
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
    const mjtNum* qvel = data_->qvel + qvel_address(i);
    motions_[i] = {vec3_from(qvel + 3), vec3_from(qacc), vec3_from(qacc + 3), vec3_from(qvel)};
  }
}

void Dynamics::capture(std::vector<double>& state) const {
  recorder_.capture(X_WB_, motions_, state);
}

}  // namespace tether::sim
