#pragma once

#include <cmath>

#include <tether/uav/multirotor.h>

namespace tether::uav {

/// The multirotor flying in free space: a semi-implicit Euler integrator around its steps, at 1
/// kHz.
class FlyingBody {
 public:
  explicit FlyingBody(MultirotorParameters parameters = hummingbird(), double yaw = 0.0)
      : multirotor_(std::move(parameters), kGravity, kDt),
        state(hover_state(multirotor_.parameters(), kGravity, yaw)) {
    body.q_WB = from_rpy(0, 0, yaw);
  }

  Wrench advance(const Setpoint& setpoint) {
    const Wrench wrench = multirotor_.step(body, setpoint, state);
    integrate(wrench);
    return wrench;
  }

  /// Calls `watch(seconds since the start of this call)` after each step.
  template <class Watch>
  void fly(const Setpoint& setpoint, double seconds, Watch watch) {
    const int steps = static_cast<int>(std::lround(seconds / kDt_s));
    for (int i = 1; i <= steps; ++i) {
      advance(setpoint);
      watch(i * kDt_s);
    }
  }
  void fly(const Setpoint& setpoint, double seconds) {
    fly(setpoint, seconds, [](double) {});
  }

  double yaw() const { return yaw_rad(body.q_WB); }
  double tilt() const { return std::acos(rotate(body.q_WB, {0, 0, 1}).z); }
  const Multirotor& multirotor() const { return multirotor_; }
  const MultirotorParameters& parameters() const { return multirotor_.parameters(); }

  static constexpr double kGravity = 9.81;
  static constexpr Duration kDt = std::chrono::milliseconds(1);
  static constexpr double kDt_s = 1e-3;

 private:
  Multirotor multirotor_;

 public:
  BodyState body;
  MultirotorState state;
  Vec3 disturbance_force_W;   ///< acts on the centre of mass [N]
  Vec3 disturbance_torque_B;  ///< [N m]

 private:
  void integrate(const Wrench& wrench) {
    const Vec3 force_W = rotate(body.q_WB, wrench.force_B) + disturbance_force_W;
    body.v_WB = body.v_WB + (kDt_s / parameters().mass_kg) * force_W - Vec3{0, 0, kGravity * kDt_s};
    body.p_WB = body.p_WB + kDt_s * body.v_WB;

    const Vec3& inertia = parameters().inertia_kg_m2;
    const Vec3& w = body.w_WB_B;
    const Vec3 torque = wrench.torque_B + disturbance_torque_B -
                        cross(w, {inertia.x * w.x, inertia.y * w.y, inertia.z * w.z});
    body.w_WB_B =
        w + kDt_s * Vec3{torque.x / inertia.x, torque.y / inertia.y, torque.z / inertia.z};
    const double rate = norm(body.w_WB_B);
    if (rate > 0.0) {
      const Vec3 axis = (1.0 / rate) * body.w_WB_B;
      body.q_WB = normalized(body.q_WB * from_axis_angle(axis, rate * kDt_s));
    }
  }
};

}  // namespace tether::uav
