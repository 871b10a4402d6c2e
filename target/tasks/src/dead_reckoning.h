#pragma once

#include <optional>

#include <tether/uav/math.h>
#include <tether/uav/samples.h>

namespace tether::tasks {

/// Gravity of the worlds that Tether simulates [m/s²].
inline constexpr double kGravity_m_s2 = 9.81;

/// Position from an IMU alone (Algorithm 5, update_travelled_distance): specific force plus
/// gravity, turned into the start-heading frame H0 (x ahead at the start, y left, z up, origin at
/// the start) by the IMU's own attitude, integrated twice by the trapezoidal rule. At rest at the
/// start.
///
/// Follows the IMU itself: one that sits off the body's centre is moved by the body's turning, too.
/// Pure arithmetic; one thread.
class DeadReckoning {
 public:
  /// `q_BS`: rotation of the IMU's mounting.
  explicit DeadReckoning(const uav::Quat& q_BS = {}) : q_SB_(inverse(q_BS)) {}

  /// A reading at rest, before the start: what the mean of all of them measures beyond gravity
  /// counts as the sensor's bias.
  void calibrate(const uav::ImuSample& reading);
  /// The next reading; the first is the start. One that is not younger than the last changes
  /// nothing.
  void update(const uav::ImuSample& reading);

  SimTime read_at() const { return last_ ? last_->sampled_at : SimTime(); }  ///< the last reading
  const uav::Vec3& position_m() const { return p_; }                         ///< in H0
  const uav::Vec3& velocity_m_s() const { return v_; }                       ///< in H0
  double yaw_rad() const { return yaw_; }             ///< since the start, in (−π, π]
  double path_length_m() const { return length_m_; }  ///< horizontal

 private:
  struct Reading {
    SimTime sampled_at;
    uav::Vec3 a_H0;
  };
  uav::Vec3 acceleration(const uav::ImuSample& reading) const;

  uav::Quat q_SB_;
  uav::Vec3 excess_S_;  ///< sum over the calibration readings
  int calibrations_ = 0;
  std::optional<Reading> last_;
  double starting_yaw_ = 0.0;  ///< in W
  uav::Vec3 p_, v_;
  double yaw_ = 0.0;
  double length_m_ = 0.0;
};

}  // namespace tether::tasks
