#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <tether/base/time.h>
#include <tether/uav/math.h>
#include <tether/uav/setpoint.h>

/// The UAV: a rigid body with rotors and a controller. Pure functions of state and input,
/// shared by all simulator back ends, so that the same UAV flies in each. The back end integrates
/// the rigid body; these functions compute the force and torque that act on it.
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

  // Limits of the controller.
  double max_tilt_rad = 0.35;
  double max_horizontal_speed_m_s = 5.0;
  double max_vertical_speed_m_s = 2.0;
  double max_yaw_rate_rad_s = 3.0;
  /// The velocity set-point follows a new command with this acceleration. Below what the tilt limit
  /// allows (3.6 m/s² at 0.35 rad), so that the UAV can follow it.
  double max_acceleration_m_s2 = 3.0;
  /// The yaw rate follows a new command with this acceleration. Below what the rotors' reaction
  /// torques can do (9.4 rad/s² at hover for the Hummingbird), so that the yaw stops without
  /// swinging back.
  double max_yaw_acceleration_rad_s2 = 6.0;
};

/// AscTec Hummingbird as documented by RotorS (hummingbird.xacro: mass, inertia, rotor and motor
/// constants).
MultirotorParameters hummingbird();

/// State of the body at a step boundary, as the controller and the rotors use it.
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
  friend bool operator==(const Wrench&, const Wrench&) = default;
};

/// State of rotors and controller between steps. Plain data of fixed size: a copy is a snapshot.
struct MultirotorState {
  static constexpr std::size_t kMaxRotors = 8;
  /// The first rotors.size() are in use.
  std::array<double, kMaxRotors> rotor_speed_rad_s{};
  bool velocity_in_W = false;   ///< the frame of the next two: W, else H
  Vec3 velocity_setpoint_m_s;   ///< the commanded velocity after its acceleration limit
  Vec3 velocity_reference_m_s;  ///< the same behind the lag with which thrust turns and grows
  Vec3 velocity_integral_W;     ///< integral term of the velocity loop [m/s²]
  Vec3 rate_integral_B;         ///< integral term of the rate loop [rad/s²]
  double yaw_rate_setpoint_rad_s = 0.0;  ///< the commanded yaw rate after its acceleration limit
  double yaw_setpoint_rad = 0.0;         ///< integral of the yaw rate set-point; in (−π, π]
  friend bool operator==(const MultirotorState&, const MultirotorState&) = default;
};

/// Collective thrust and torques about the centre of mass, body axes [N, N m].
struct Demand {
  double thrust_N = 0.0;
  Vec3 torque_B_N_m;
};

using RotorThrusts = std::array<double, MultirotorState::kMaxRotors>;  // [N]
using RotorSpeeds = std::array<double, MultirotorState::kMaxRotors>;   // [rad/s]

double max_rotor_thrust_N(const MultirotorParameters& parameters);
/// Of all rotors together at full speed.
FlightLimits flight_limits(const MultirotorParameters& parameters);
/// What the controller can hold up that it does not know of [kg]: with more, a UAV that holds its
/// height sinks.
double max_unknown_load_kg(const MultirotorParameters& parameters, double gravity_m_s2);

/// Divides a demand among the rotors of a layout.
class Mixer {
 public:
  explicit Mixer(const MultirotorParameters& parameters);

  /// Thrust of each rotor that produces `demand`, by the pseudo-inverse of the layout's allocation
  /// matrix: the least sum of squares where there are more than four rotors. All within
  /// [0, limit_N]; where that is not enough, yaw torque is scaled down first, then roll and pitch
  /// torque.
  RotorThrusts mix(const Demand& demand, double limit_N) const;

 private:
  using Vec4 = std::array<double, 4>;  // thrust, roll, pitch, yaw

  /// For three demands at once.
  std::array<RotorThrusts, 3> thrusts_for(const std::array<Vec4, 3>& wanted) const;

  std::size_t count_;
  std::array<Vec4, MultirotorState::kMaxRotors> effects_{};  // of one newton: columns of A
  std::array<Vec4, 4> gram_{};                               // lower Cholesky factor of A·Aᵀ
};

/// Rotors at hover thrust and the controller at rest, heading along `yaw_rad`, as if it had hovered
/// in a wind `v_WA` before.
MultirotorState hover_state(const MultirotorParameters& parameters, double gravity_m_s2,
                            double yaw_rad, const Vec3& v_WA = {});

/// A multirotor with its controller, stepped in a world. What its steps need of the parameters
/// alone is computed once.
class Multirotor {
 public:
  Multirotor(MultirotorParameters parameters, double gravity_m_s2, Duration step);

  const MultirotorParameters& parameters() const { return parameters_; }
  /// Rotors that turn faster slow down to this.
  void limit_rotor_speed(double rad_s) { parameters_.max_rotor_speed_rad_s = rad_s; }

  /// One step of controller and rotors: cascaded position → velocity → acceleration → attitude →
  /// body rates → rotor speeds, entered at the level of the set-point (geometric attitude error
  /// after Lee, Leok, McClamroch, CDC 2010), first-order rotors, thrust, reaction torque and rotor
  /// drag.
  ///
  /// Call once per step with the state at its beginning; apply the returned wrench for the whole
  /// step. Deterministic, allocates nothing, never fails: non-finite input gives a non-finite
  /// wrench. `v_WA`: the wind, which drags the rotors and the airframe along; the controller does
  /// not know it. @pre the mask of `setpoint` has a level, and it has as many rotor speeds as
  /// rotors
  Wrench step(const BodyState& body, const Setpoint& setpoint, MultirotorState& state,
              const Vec3& v_WA = {}) const;

 private:
  RotorSpeeds wanted_speeds(const BodyState& body, const Setpoint& setpoint,
                            MultirotorState& state) const;
  void advance_rotors(const RotorSpeeds& wanted, MultirotorState& state) const;

  MultirotorParameters parameters_;
  double gravity_m_s2_;
  double dt_s_;
  double up_, down_;  // shares of the way to the wanted speed within a step
  Mixer mixer_;
};

}  // namespace tether::uav
