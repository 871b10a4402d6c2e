#include "cascade.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <tether/base/units.h>
#include <tether/uav/multirotor.h>

namespace tether::uav {
namespace {

double speed_for(const MultirotorParameters& parameters, double thrust_N) {
  return std::sqrt(thrust_N / parameters.thrust_coefficient);
}

/// Thrust, reaction torque and drag of all rotors at their speeds (Furrer et al., eqs. 5 to 8).
/// `v_B`: velocity of the body through the air.
Wrench rotor_wrench(const MultirotorParameters& parameters, const BodyState& body, const Vec3& v_B,
                    const MultirotorState& state) {
  Wrench sum;
  for (std::size_t i = 0; i < parameters.rotors.size(); ++i) {
    const Rotor& rotor = parameters.rotors[i];
    const double speed = state.rotor_speed_rad_s[i];
    const double thrust = parameters.thrust_coefficient * speed * speed;
    const double drag = parameters.drag_coefficient * std::abs(speed);
    const Vec3 v_hub = v_B + cross(body.w_WB_B, rotor.p_BR);
    const Vec3 force{-drag * v_hub.x, -drag * v_hub.y, thrust};
    const Vec3 reaction{0, 0, -rotor.direction * parameters.moment_coefficient_m * thrust};
    sum.force_B = sum.force_B + force;
    sum.torque_B = sum.torque_B + cross(rotor.p_BR, force) + reaction;
  }
  return sum;
}

}  // namespace

MultirotorParameters hummingbird() {
  // RotorS, rotors_description/urdf/hummingbird.xacro, which takes the figures of Wang et al.,
  // "Novel dynamic inversion architecture design for quadrocopter control". The mass is the body's
  // 0.68 kg and four rotors of 9 g.
  constexpr double kArm_m = 0.17;
  constexpr double kRotorHeight_m = 0.01;
  MultirotorParameters p;
  p.mass_kg = 0.716;
  p.inertia_kg_m2 = {0.007, 0.007, 0.012};
  p.rotors = {{{kArm_m, 0, kRotorHeight_m}, -1},
              {{0, kArm_m, kRotorHeight_m}, +1},
              {{-kArm_m, 0, kRotorHeight_m}, -1},
              {{0, -kArm_m, kRotorHeight_m}, +1}};
  p.thrust_coefficient = 8.54858e-06;
  p.moment_coefficient_m = 0.016;
  p.drag_coefficient = 8.06428e-05;
  p.max_rotor_speed_rad_s = 838.0;
  p.time_constant_up_s = 0.0125;
  p.time_constant_down_s = 0.025;
  return p;
}

MultirotorState hover_state(const MultirotorParameters& parameters, double gravity_m_s2,
                            double yaw_rad, const Vec3& v_WA) {
  const RotorThrusts thrusts =
      Mixer(parameters)
          .mix({parameters.mass_kg * gravity_m_s2, {}}, max_rotor_thrust_N(parameters));
  MultirotorState state;
  double level_drag_N_s_m = parameters.linear_drag_N_s_m;
  for (std::size_t i = 0; i < parameters.rotors.size(); ++i) {
    state.rotor_speed_rad_s[i] = speed_for(parameters, thrusts[i]);
    level_drag_N_s_m += parameters.drag_coefficient * state.rotor_speed_rad_s[i];
  }
  const Vec3 drag_N{level_drag_N_s_m * v_WA.x, level_drag_N_s_m * v_WA.y,
                    parameters.linear_drag_N_s_m * v_WA.z};
  if (v_WA != Vec3{}) state.velocity_integral_W = (-1.0 / parameters.mass_kg) * drag_N;
  state.yaw_setpoint_rad = wrap_angle_rad(yaw_rad);
  return state;
}

Multirotor::Multirotor(MultirotorParameters parameters, double gravity_m_s2, Duration step)
    : parameters_(std::move(parameters)),
      gravity_m_s2_(gravity_m_s2),
      dt_s_(to_seconds(step)),
      up_(-std::expm1(-dt_s_ / parameters_.time_constant_up_s)),
      down_(-std::expm1(-dt_s_ / parameters_.time_constant_down_s)),
      mixer_(parameters_) {}

RotorSpeeds Multirotor::wanted_speeds(const BodyState& body, const Setpoint& setpoint,
                                      MultirotorState& state) const {
  RotorSpeeds speeds{};
  if (level_of(setpoint.mask) == SetpointLevel::kRotors) {
    follow_motion(body, state);
    for (std::size_t i = 0; i < parameters_.rotors.size(); ++i)
      speeds[i] = std::min(setpoint.rotor_speeds_rad_s[i], parameters_.max_rotor_speed_rad_s);
    return speeds;
  }
  const Demand demand = control(parameters_, gravity_m_s2_, body, setpoint, dt_s_, state);
  const RotorThrusts thrusts = mixer_.mix(demand, max_rotor_thrust_N(parameters_));
  for (std::size_t i = 0; i < parameters_.rotors.size(); ++i)
    speeds[i] = speed_for(parameters_, thrusts[i]);
  return speeds;
}

Wrench Multirotor::step(const BodyState& body, const Setpoint& setpoint, MultirotorState& state,
                        const Vec3& v_WA) const {
  advance_rotors(wanted_speeds(body, setpoint, state), state);

  const Vec3 v_B = rotate(inverse(body.q_WB), body.v_WB - v_WA);
  Wrench wrench = rotor_wrench(parameters_, body, v_B, state);
  wrench.force_B = wrench.force_B - parameters_.linear_drag_N_s_m * v_B;
  return wrench;
}

// First-order lag towards the wanted speeds, exact for a set-point that holds over the step.
void Multirotor::advance_rotors(const RotorSpeeds& wanted, MultirotorState& state) const {
  for (std::size_t i = 0; i < parameters_.rotors.size(); ++i) {
    double& speed = state.rotor_speed_rad_s[i];
    speed += (wanted[i] > speed ? up_ : down_) * (wanted[i] - speed);
  }
}

}  // namespace tether::uav
