#include "cascade.h"

#include <algorithm>
#include <cmath>

#include <tether/base/units.h>

/// Cascaded loops. A position gives a velocity; velocity and yaw rate pass acceleration limits and
/// become set-points; the velocity loop computes the force in W; the attitude that points the
/// thrust along it gives the set-point of the body's rate; the rate loop computes the torques. A
/// set-point enters at its own level.
namespace tether::uav {
namespace {

// Gains. Each loop is several times faster than the one around it; the innermost is bounded by the
// rotors' lag of 10 to 25 ms. All act on accelerations, so that they hold for any mass and inertia.
constexpr double kVelocityGain_1_s = 2.6;
/// How long the acceleration takes to follow: the attitude loops ahead and aside, the rotors
/// upwards.
constexpr Vec3 kAccelerationLag_s{0.20, 0.20, 0.02};
constexpr double kVelocityIntegralGain_1_s2 = 1.2;
constexpr double kMaxVelocityIntegral_m_s2 = 2.0;
constexpr double kMaxIntegratedError_m_s = 0.5;  // of an upset, which is not a lasting disturbance
constexpr Vec3 kAttitudeGain_1_s{7.0, 7.0, 5.0};
constexpr Vec3 kRateGain_1_s{24.0, 24.0, 18.0};
constexpr double kRateIntegralGain_1_s2 = 25.0;
constexpr double kMaxRateIntegral_rad_s2 = 5.0;

// Limits of the thrust, so that the rotors can always turn the body as well.
constexpr double kMinThrustOfWeight = 0.3;
constexpr double kMaxThrustOfRotors = 0.85;

/// Share of the acceleration limit with which the UAV brakes before a position or a yaw: the rest
/// is for the lag of the loops within.
constexpr double kBrakingShare = 0.5;

/// The yaw set-point is never further ahead of the yaw than this, so that a UAV that was prevented
/// from turning does not unwind later.
constexpr double kMaxYawLead_rad = 0.2;

constexpr double clamp_to(double value, double limit) {
  return std::clamp(value, -limit, limit);
}

Vec3 scaled_by(const Vec3& a, const Vec3& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// Shortens the horizontal part of `v` to at most `limit`.
Vec3 with_horizontal_limit(const Vec3& v, double limit) {
  const double length = std::hypot(v.x, v.y);
  const double scale = length > limit ? limit / length : 1.0;
  return {scale * v.x, scale * v.y, v.z};
}

/// Turns `v` by `yaw` about z: H → W.
Vec3 from_heading(double yaw, const Vec3& v) {
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

/// The speed towards something at this distance: proportional to it nearby, and such that a
/// constant deceleration stops there from afar. Both meet with one slope.
double approach_speed(double distance, double gain_1_s, double deceleration) {
  const double near = deceleration / (gain_1_s * gain_1_s);
  if (distance <= near) return gain_1_s * distance;
  return std::sqrt(2.0 * deceleration * (distance - 0.5 * near));
}
double approach(double error, double gain_1_s, double deceleration) {
  return std::copysign(approach_speed(std::abs(error), gain_1_s, deceleration), error);
}

struct Axes {
  Vec3 x, y, z;
};

Axes axes_of(const Quat& q) {
  return {rotate(q, {1, 0, 0}), rotate(q, {0, 1, 0}), rotate(q, {0, 0, 1})};
}

/// The yaw rate that is asked for: a given one, or the one that leads to a given yaw.
double commanded_yaw_rate(const MultirotorParameters& parameters, const Setpoint& setpoint,
                          const MultirotorState& state) {
  if (setpoint.has(kYawRate)) return setpoint.yaw_rate_rad_s;
  if (!setpoint.has(kYaw)) return 0.0;
  return approach(wrap_angle_rad(setpoint.yaw_rad - state.yaw_setpoint_rad), kYawGain_1_s,
                  kBrakingShare * parameters.max_yaw_acceleration_rad_s2);
}

/// The yaw set-point: the commanded rate behind an acceleration limit, integrated. Returns the
/// acceleration in use [rad/s²].
double advance_yaw_setpoint(const MultirotorParameters& parameters, double commanded_rate,
                            double yaw, double dt_s, MultirotorState& state) {
  const double target = clamp_to(commanded_rate, parameters.max_yaw_rate_rad_s);
  const double max_change = parameters.max_yaw_acceleration_rad_s2 * dt_s;
  const double change = clamp_to(target - state.yaw_rate_setpoint_rad_s, max_change);
  const double advance = (state.yaw_rate_setpoint_rad_s + 0.5 * change) * dt_s;
  state.yaw_rate_setpoint_rad_s += change;

  const double lead = wrap_angle_rad(state.yaw_setpoint_rad + advance - yaw);
  state.yaw_setpoint_rad = wrap_angle_rad(yaw + clamp_to(lead, kMaxYawLead_rad));
  return change / dt_s;
}

/// Position loop: the velocity that leads to the position, added to one that is fed forward.
Vec3 commanded_velocity_W(const MultirotorParameters& parameters, const Vec3& p_WB,
                          const Setpoint& setpoint) {
  const double deceleration = kBrakingShare * parameters.max_acceleration_m_s2;
  const Vec3 error = setpoint.p_WB_m - p_WB;
  const double distance = std::hypot(error.x, error.y);
  const double scale =
      distance > 0.0 ? approach_speed(distance, kPositionGain_1_s, deceleration) / distance : 0.0;
  const Vec3 towards{scale * error.x, scale * error.y,
                     approach(error.z, kPositionGain_1_s, deceleration)};
  return setpoint.has(kVelocity) ? setpoint.velocity_m_s + towards : towards;
}

struct VelocitySetpoint {
  Vec3 velocity_W;      // where the velocity should be by now [m/s]
  Vec3 acceleration_W;  // fed forward, with the centripetal one of a turning heading [m/s²]
};

/// The velocity loop rests.
void follow_velocity(const BodyState& body, MultirotorState& state) {
  state.velocity_in_W = true;
  state.velocity_setpoint_m_s = state.velocity_reference_m_s = body.v_WB;
}

/// The velocity set-points keep their direction in W when their frame changes.
void bring_to_frame(bool in_W, double yaw, MultirotorState& state) {
  if (state.velocity_in_W == in_W) return;
  const double turned = in_W ? yaw : -yaw;
  state.velocity_in_W = in_W;
  state.velocity_setpoint_m_s = from_heading(turned, state.velocity_setpoint_m_s);
  state.velocity_reference_m_s = from_heading(turned, state.velocity_reference_m_s);
}

/// The commanded velocity, within its limits, behind an acceleration limit. The reference for the
/// velocity error follows with a lag, so that an unavoidable following error does not wind up the
/// integral.
VelocitySetpoint advance_velocity_setpoint(const MultirotorParameters& parameters,
                                           const Vec3& commanded, const Setpoint& given, double yaw,
                                           double dt_s, MultirotorState& state) {
  bring_to_frame(!given.in_heading, yaw, state);
  Vec3 target = with_horizontal_limit(commanded, parameters.max_horizontal_speed_m_s);
  target.z = clamp_to(target.z, parameters.max_vertical_speed_m_s);
  const double max_change = parameters.max_acceleration_m_s2 * dt_s;
  Vec3& setpoint = state.velocity_setpoint_m_s;
  Vec3 change = with_horizontal_limit(target - setpoint, max_change);
  change.z = clamp_to(change.z, max_change);
  setpoint = setpoint + change;

  Vec3& reference = state.velocity_reference_m_s;
  const Vec3 follow{dt_s / (kAccelerationLag_s.x + dt_s), dt_s / (kAccelerationLag_s.y + dt_s),
                    dt_s / (kAccelerationLag_s.z + dt_s)};
  reference = reference + scaled_by(follow, setpoint - reference);

  const Vec3 forward = given.has(kAcceleration) ? given.acceleration_m_s2 : (1.0 / dt_s) * change;
  if (!given.in_heading) return {reference, forward};
  const Vec3 turning = cross({0, 0, state.yaw_rate_setpoint_rad_s}, setpoint);
  return {from_heading(yaw, reference), from_heading(yaw, forward + turning)};
}

/// Drag of the rotors across their axes, as fast as they spin now [N s/m].
double rotor_drag_N_s_m(const MultirotorParameters& parameters, const MultirotorState& state) {
  double speeds = 0.0;
  for (std::size_t i = 0; i < parameters.rotors.size(); ++i) {
    speeds += state.rotor_speed_rad_s[i];
  }
  return parameters.drag_coefficient * speeds;
}

/// Drag of airframe and rotors, whose axes are all but vertical, at this velocity [N].
Vec3 drag_N(const MultirotorParameters& parameters, const MultirotorState& state, const Vec3& v_W) {
  const double airframe = parameters.linear_drag_N_s_m;
  const double across = airframe + rotor_drag_N_s_m(parameters, state);
  return {across * v_W.x, across * v_W.y, airframe * v_W.z};
}

/// The most that is left of the thrust at the largest tilt [N].
double max_upward_force_N(const MultirotorParameters& parameters) {
  return kMaxThrustOfRotors * flight_limits(parameters).max_thrust_N *
         std::cos(parameters.max_tilt_rad);
}

/// Force within what thrust and tilt allow.
Vec3 limited_force(const MultirotorParameters& parameters, double gravity_m_s2, const Vec3& asked) {
  const double min_up = kMinThrustOfWeight * parameters.mass_kg * gravity_m_s2;
  const double max_up = std::max(min_up, max_upward_force_N(parameters));
  const Vec3 force{asked.x, asked.y, std::clamp(asked.z, min_up, max_up)};
  return with_horizontal_limit(force, force.z * std::tan(parameters.max_tilt_rad));
}

/// The integral of an axis does not change while that axis is at its limit.
void advance_velocity_integral(const Vec3& error, const Vec3& asked, const Vec3& force, double dt_s,
                               Vec3& integral) {
  const double gain = kVelocityIntegralGain_1_s2 * dt_s;
  if (force.x == asked.x && force.y == asked.y) {
    const Vec3 bounded = with_horizontal_limit(error, kMaxIntegratedError_m_s);
    integral.x += gain * bounded.x;
    integral.y += gain * bounded.y;
    integral = with_horizontal_limit(integral, kMaxVelocityIntegral_m_s2);
  }
  if (force.z == asked.z) {
    integral.z += gain * clamp_to(error.z, kMaxIntegratedError_m_s);
    integral.z = clamp_to(integral.z, kMaxVelocityIntegral_m_s2);
  }
}

/// Velocity loop: the force that the rotors shall exert, in W [N]. PI on the velocity; weight, drag
/// and the acceleration of the set-point are fed forward.
Vec3 wanted_force_W(const MultirotorParameters& parameters, double gravity_m_s2,
                    const BodyState& body, const VelocitySetpoint& setpoint, double dt_s,
                    MultirotorState& state) {
  const double mass = parameters.mass_kg;
  const Vec3 error = setpoint.velocity_W - body.v_WB;
  const Vec3 acceleration = kVelocityGain_1_s * error + state.velocity_integral_W +
                            setpoint.acceleration_W + Vec3{0, 0, gravity_m_s2};
  const Vec3 asked = mass * acceleration + drag_N(parameters, state, setpoint.velocity_W);
  const Vec3 force = limited_force(parameters, gravity_m_s2, asked);
  advance_velocity_integral(error, asked, force, dt_s, state.velocity_integral_W);
  return force;
}

/// Acceleration level: weight and the drag at the present velocity and attitude are fed forward,
/// nothing is fed back.
Vec3 force_for_acceleration_W(const MultirotorParameters& parameters, double gravity_m_s2,
                              const Vec3& v_W, const Vec3& up_W, const Vec3& acceleration_W,
                              const MultirotorState& state) {
  const Vec3 across = v_W - dot(v_W, up_W) * up_W;
  return limited_force(parameters, gravity_m_s2,
                       parameters.mass_kg * (acceleration_W + Vec3{0, 0, gravity_m_s2}) +
                           parameters.linear_drag_N_s_m * v_W +
                           rotor_drag_N_s_m(parameters, state) * across);
}

/// The attitude whose z is along `force_W` and whose x heads along `yaw` (Lee 2010, eq. 12 and
/// after).
Axes wanted_attitude(const Vec3& force_W, double yaw) {
  const Vec3 z = (1.0 / norm(force_W)) * force_W;
  const Vec3 sideways = cross(z, {std::cos(yaw), std::sin(yaw), 0.0});
  const Vec3 y = (1.0 / norm(sideways)) * sideways;
  return {cross(y, z), y, z};
}

/// ½ (R_dᵀ R − Rᵀ R_d)^∨, in B [rad for small angles] (Lee 2010, eq. 10).
Vec3 attitude_error_B(const Axes& actual, const Axes& wanted) {
  return 0.5 * Vec3{dot(wanted.z, actual.y) - dot(wanted.y, actual.z),
                    dot(wanted.x, actual.z) - dot(wanted.z, actual.x),
                    dot(wanted.y, actual.x) - dot(wanted.x, actual.y)};
}

/// Inner loop: torques [N m] that bring the body's rate to `rate_setpoint_B`. PI, with the
/// set-point's acceleration and the gyroscopic torque fed forward.
Vec3 wanted_torque_B(const MultirotorParameters& parameters, const BodyState& body,
                     const Vec3& rate_setpoint_B, const Vec3& acceleration_B, double dt_s,
                     MultirotorState& state) {
  const Vec3 error = rate_setpoint_B - body.w_WB_B;
  const Vec3 acceleration =
      scaled_by(kRateGain_1_s, error) + state.rate_integral_B + acceleration_B;
  const Vec3 integral = state.rate_integral_B + (kRateIntegralGain_1_s2 * dt_s) * error;
  state.rate_integral_B = {clamp_to(integral.x, kMaxRateIntegral_rad_s2),
                           clamp_to(integral.y, kMaxRateIntegral_rad_s2),
                           clamp_to(integral.z, kMaxRateIntegral_rad_s2)};
  const Vec3 momentum = scaled_by(parameters.inertia_kg_m2, body.w_WB_B);
  return scaled_by(parameters.inertia_kg_m2, acceleration) + cross(body.w_WB_B, momentum);
}

/// What the outer loops ask of the attitude and rate loops.
struct Wanted {
  double thrust_N = 0.0;
  Axes attitude;
  double yaw_rate_rad_s = 0.0;  // about z in W, fed forward
  double yaw_acceleration_rad_s2 = 0.0;
};

/// Position, velocity and acceleration levels.
Wanted wanted_of_motion(const MultirotorParameters& parameters, double gravity_m_s2,
                        const BodyState& body, const Axes& actual, const Setpoint& setpoint,
                        double dt_s, MultirotorState& state) {
  const double yaw = yaw_rad(body.q_WB);
  const double yaw_acceleration = advance_yaw_setpoint(
      parameters, commanded_yaw_rate(parameters, setpoint, state), yaw, dt_s, state);
  Vec3 force_W;
  if (level_of(setpoint.mask) == SetpointLevel::kAcceleration) {
    follow_velocity(body, state);
    const Vec3& given = setpoint.acceleration_m_s2;
    force_W =
        force_for_acceleration_W(parameters, gravity_m_s2, body.v_WB, actual.z,
                                 setpoint.in_heading ? from_heading(yaw, given) : given, state);
  } else {
    const Vec3 commanded = setpoint.has(kPosition)
                               ? commanded_velocity_W(parameters, body.p_WB, setpoint)
                               : setpoint.velocity_m_s;
    const VelocitySetpoint velocity =
        advance_velocity_setpoint(parameters, commanded, setpoint, yaw, dt_s, state);
    force_W = wanted_force_W(parameters, gravity_m_s2, body, velocity, dt_s, state);
  }
  return {dot(force_W, actual.z), wanted_attitude(force_W, state.yaw_setpoint_rad),
          state.yaw_rate_setpoint_rad_s, yaw_acceleration};
}

}  // namespace

double max_unknown_load_kg(const MultirotorParameters& parameters, double gravity_m_s2) {
  const double by_integral_N = kMaxVelocityIntegral_m_s2 * parameters.mass_kg;
  const double by_thrust_N = max_upward_force_N(parameters) - parameters.mass_kg * gravity_m_s2;
  return std::max(0.0, std::min(by_integral_N, by_thrust_N)) / gravity_m_s2;
}

void follow_motion(const BodyState& body, MultirotorState& state) {
  follow_velocity(body, state);
  state.yaw_setpoint_rad = yaw_rad(body.q_WB);
  state.yaw_rate_setpoint_rad_s = 0.0;
}

Demand control(const MultirotorParameters& parameters, double gravity_m_s2, const BodyState& body,
               const Setpoint& setpoint, double dt_s, MultirotorState& state) {
  const SetpointLevel level = *level_of(setpoint.mask);
  if (level > SetpointLevel::kAcceleration) follow_motion(body, state);
  if (level == SetpointLevel::kBodyRates)
    return {setpoint.thrust_N,
            wanted_torque_B(parameters, body, setpoint.w_WB_B_rad_s, {}, dt_s, state)};

  const Axes actual = axes_of(body.q_WB);
  const Wanted wanted =
      level == SetpointLevel::kAttitude
          ? Wanted{setpoint.thrust_N, axes_of(setpoint.q_WB)}
          : wanted_of_motion(parameters, gravity_m_s2, body, actual, setpoint, dt_s, state);
  const Vec3 error_B = attitude_error_B(actual, wanted.attitude);

  // World z in B is the third row of R.
  const Vec3 up_B{actual.x.z, actual.y.z, actual.z.z};
  const Vec3 rate_setpoint_B = wanted.yaw_rate_rad_s * up_B - scaled_by(kAttitudeGain_1_s, error_B);
  const Vec3 torque_B = wanted_torque_B(parameters, body, rate_setpoint_B,
                                        wanted.yaw_acceleration_rad_s2 * up_B, dt_s, state);
  return {wanted.thrust_N, torque_B};
}

}  // namespace tether::uav
