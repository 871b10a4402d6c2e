#pragma once

#include <array>
#include <vector>

#include <tether/base/time.h>
#include <tether/uav/math.h>
#include <tether/uav/samples.h>

/// The UAV itself: a rigid body with rotors under a velocity controller. Pure functions of state
/// and input, shared by every simulator back end, so that the same UAV flies in all of them. The
/// back end integrates the rigid body; this header says which force and torque act on it.
namespace tether::uav {

/// One rotor, spinning about the body's +z.
struct Rotor {
  Vec3 p_BR;          ///< hub [m]
  int direction = 1;  ///< +1 counter-clockwise, −1 clockwise, seen from above
};

/// Parameters of the airframe and its rotors (the model of Furrer et al., "RotorS", Springer 2016,
/// section 3).
struct MultirotorParameters {
  double mass_kg = 0.0;
  Vec3 inertia_kg_m2;                 ///< principal, about the centre of mass, body axes
  std::vector<Rotor> rotors;          ///< four in + or × configuration
  double thrust_coefficient = 0.0;    ///< thrust = c·ω² [N s²/rad²]
  double moment_coefficient_m = 0.0;  ///< reaction torque = this · thrust [m]
  double drag_coefficient = 0.0;      ///< rotor drag force = −c·|ω|·v⊥ [N s²/(rad m)]
  double linear_drag_N_s_m = 0.0;     ///< airframe drag: −this·v [N s/m]
  double max_rotor_speed_rad_s = 0.0;
  double time_constant_up_s = 0.0;
  double time_constant_down_s = 0.0;

  // Limits of the velocity controller.
  double max_tilt_rad = 0.35;
  double max_horizontal_speed_m_s = 5.0;
  double max_vertical_speed_m_s = 2.0;
  double max_yaw_rate_rad_s = 3.0;
};

/// AscTec Hummingbird as documented by RotorS (hummingbird.xacro: mass, inertia, rotor and motor
/// constants).
MultirotorParameters hummingbird();

/// What the controller and the rotors know of the body at a step boundary.
struct BodyState {
  Vec3 p_WB;  ///< [m]
  Quat q_WB;
  Vec3 v_WB;    ///< in W [m/s]
  Vec3 w_WB_B;  ///< angular velocity in B [rad/s]
};

/// Force and torque on the centre of mass, both in body axes [N, N m].
struct Wrench {
  Vec3 force_B;
  Vec3 torque_B;
};

/// State of rotors and controller between steps. Plain data, fixed size: copying it is the
/// snapshot.
struct MultirotorState {
  static constexpr std::size_t kMaxRotors = 8;
  std::array<double, kMaxRotors> rotor_speed_rad_s{};  ///< the first rotors.size() are in use
  Vec3 velocity_integral_W;       ///< integral term of the velocity loop [m/s²]
  Vec3 rate_integral_B;           ///< integral term of the rate loop [rad/s²]
  double yaw_setpoint_rad = 0.0;  ///< yaw set-point, the integral of the commanded yaw rate
};

/// Rotors at hover thrust and the controller at rest, heading along `yaw_rad`.
MultirotorState hover_state(const MultirotorParameters& parameters, double gravity_m_s2,
                            double yaw_rad);

/// One step of controller and rotors: cascaded velocity → attitude → body rate → rotor speeds
/// (geometric attitude error after Lee, Leok, McClamroch, CDC 2010), first-order rotors, thrust,
/// reaction torque and rotor drag.
///
/// Call once per step with the state at its beginning; apply the returned wrench for the whole
/// step. Deterministic, allocates nothing, never fails: non-finite input gives a non-finite wrench.
Wrench step(const MultirotorParameters& parameters, double gravity_m_s2, const BodyState& body,
            const VelocityCommand& command, Duration dt, MultirotorState& state);

}  // namespace tether::uav
