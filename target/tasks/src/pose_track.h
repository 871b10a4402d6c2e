#pragma once

#include <deque>

#include <tether/base/time.h>
#include <tether/uav/math.h>
#include <tether/uav/samples.h>

namespace tether::tasks {

/// Where a UAV is and was, in the frame W of its odometry: the readings of an IMU, integrated by
/// the trapezoidal rule, follow each motion, and the odometry holds them in place. Remembers two
/// seconds, because images arrive late. Pure arithmetic; one thread.
class PoseTrack {
 public:
  struct State {
    SimTime at;
    uav::Vec3 p_WB;
    uav::Vec3 v_WB_m_s;
    uav::Quat q_WB;
  };

  /// `q_BS`: rotation of the IMU's mounting.
  explicit PoseTrack(const uav::Quat& q_BS = {}) : q_SB_(inverse(q_BS)) {}

  /// The next reading. One that is not younger than the last changes nothing.
  void update(const uav::ImuSample& reading);
  /// The first one is the start; before it, readings of the IMU change nothing.
  void update(const uav::OdometrySample& odometry);

  /// @pre has_started()
  const State& now() const { return states_.back(); }
  bool has_started() const { return !states_.empty(); }
  /// The state at an instant, or the one that is nearest in time. @pre has_started()
  const State& at(SimTime instant) const;

 private:
  uav::Quat q_SB_;
  uav::Vec3 a_W_;  ///< at the last state
  std::deque<State> states_;
};

}  // namespace tether::tasks
