#pragma once

#include <cmath>

#include <tether/base/time.h>
#include <tether/uav/multirotor.h>
#include <tether/uav/setpoint.h>

namespace tether::autopilot {

/// A vehicle that starts on the ground is set down there first; what it stands on may move.
class SetDown {
 public:
  static uav::Setpoint setpoint() {
    constexpr double kSpeed_m_s = 0.3;
    uav::Setpoint down;
    down.velocity_m_s.z = -kSpeed_m_s;
    return down;
  }
  /// Whether it stands. @pre in the order of time
  bool is_done(SimTime now, const uav::BodyState& truth) {
    constexpr double kStill_m_s = 0.05;
    constexpr Duration kLeast = std::chrono::milliseconds(500),
                       kStillFor = std::chrono::milliseconds(200);
    if (std::abs(truth.v_WB.z) > kStill_m_s || now < SimTime(kLeast)) still_since_ = now;
    return now - still_since_ >= kStillFor;
  }

 private:
  SimTime still_since_{};
};

}  // namespace tether::autopilot
