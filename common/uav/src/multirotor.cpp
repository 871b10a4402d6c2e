#include "mixer.h"
#include "velocity_controller.h"

#include <algorithm>
#include <cmath>

#include <tether/base/units.h>
#include <tether/uav/multirotor.h>

namespace tether::uav {
namespace {

double speed_for(const MultirotorParameters& parameters, double thrust_N) {
  return std::sqrt(thrust_N / parameters.thrust_coefficient);
}

/// First-order lag towards the wanted speeds, exact for a set-point that holds over the step.
void advance_rotors(const MultirotorParameters& parameters, const RotorThrusts& wanted, double dt_s,
                    MultirotorState& state) {
  const double up = -std::expm1(-dt_s / parameters.time_constant_up_s);
  const double down = -std::expm1(-dt_s / parameters.time_constant_down_s);
  for (std::size_t i = 0; i < parameters.rotors.size(); ++i) {
    double& speed = state.rotor_speed_rad_s[i];
    const double target = speed_for(parameters, wanted[i]);
    speed += (target > speed ? up : down) * (target - speed);
  }
}

/// Thrust, reaction torque and drag of all rotors at their speeds (Furrer et al., eqs. 5 to 8).
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
                            double yaw_rad) {
  const RotorThrusts thrusts = mix(parameters, {parameters.mass_kg * gravity_m_s2, {}});
  MultirotorState state;
  for (std::size_t i = 0; i < parameters.rotors.size(); ++i) {
    state.rotor_speed_rad_s[i] = speed_for(parameters, thrusts[i]);
  }
  state.yaw_setpoint_rad = wrap_angle_rad(yaw_rad);
  return state;
}

Wrench step(const MultirotorParameters& parameters, double gravity_m_s2, const BodyState& body,
            const VelocityCommand& command, Duration dt, MultirotorState& state) {
  const double dt_s = to_seconds(dt);
  const Demand demand = control(parameters, gravity_m_s2, body, command, dt_s, state);
  advance_rotors(parameters, mix(parameters, demand), dt_s, state);

  const Vec3 v_B = rotate(inverse(body.q_WB), body.v_WB);
  Wrench wrench = rotor_wrench(parameters, body, v_B, state);
  wrench.force_B = wrench.force_B - parameters.linear_drag_N_s_m * v_B;
  return wrench;
}

}  // namespace tether::uav
