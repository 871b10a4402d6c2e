#include "dead_reckoning.h"

#include <cmath>

#include <tether/base/units.h>

namespace tether::tasks {
namespace {

constexpr uav::Vec3 kUp_m_s2{0, 0, kGravity_m_s2};

}  // namespace

void DeadReckoning::calibrate(const uav::ImuSample& reading) {
  excess_S_ = excess_S_ + reading.specific_force_m_s2 - rotate(inverse(reading.q_WS), kUp_m_s2);
  ++calibrations_;
}

uav::Vec3 DeadReckoning::acceleration(const uav::ImuSample& reading) const {
  const uav::Vec3 bias_S = calibrations_ > 0 ? (1.0 / calibrations_) * excess_S_ : uav::Vec3{};
  const uav::Vec3 a_W = rotate(reading.q_WS, reading.specific_force_m_s2 - bias_S) - kUp_m_s2;
  return rotate(uav::from_axis_angle({0, 0, 1}, -starting_yaw_), a_W);
}

void DeadReckoning::update(const uav::ImuSample& reading) {
  const double yaw = uav::yaw_rad(reading.q_WS * q_SB_);
  if (!last_) {
    starting_yaw_ = yaw;
    last_ = {reading.sampled_at, acceleration(reading)};
    return;
  }
  const double dt_s = to_seconds(reading.sampled_at - last_->sampled_at);
  if (dt_s <= 0.0) return;
  const uav::Vec3 a = acceleration(reading);
  const uav::Vec3 v = v_ + (0.5 * dt_s) * (last_->a_H0 + a);
  const uav::Vec3 step = (0.5 * dt_s) * (v_ + v);
  p_ = p_ + step;
  v_ = v;
  yaw_ = wrap_angle_rad(yaw - starting_yaw_);
  length_m_ += std::hypot(step.x, step.y);
  last_ = {reading.sampled_at, a};
}

}  // namespace tether::tasks
