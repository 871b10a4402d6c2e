#pragma once

#include "vehicle.h"

#include <array>
#include <optional>
#include <string>

#include <tether/mavlink/message.h>
#include <tether/uav/setpoint.h>

namespace tether::autopilot {

/// The companion's set-points: SET_POSITION_TARGET_LOCAL_NED, SET_POSITION_TARGET_GLOBAL_INT and
/// SET_ATTITUDE_TARGET.
class Offboard {
 public:
  /// A message of these. Returns what is wrong with it; empty: it is a set-point.
  std::string on_message(const mavlink::Message& message, const Vehicle& vehicle);
  static bool takes(const mavlink::Message& message);

  /// Whether set-points have come for a second, none more than half a second after the one before.
  bool is_streaming(SimTime now) const;
  /// Whether none has come for longer than that.
  bool is_lost(SimTime now, Duration timeout) const;
  /// What the last one asks for now. @pre one has come
  uav::Setpoint setpoint(const Vehicle& vehicle) const;
  bool has_setpoint() const { return last_at_.has_value(); }

 private:
  using Axes = std::array<std::optional<double>, 3>;  // of W, or north, east and down
  /// Of axes that are given, in L.
  struct Target {
    Axes p_m, v_m_s;
    std::optional<uav::Vec3> acceleration_m_s2;
    std::optional<double> yaw_rad;         // from north, clockwise
    std::optional<double> yaw_rate_rad_s;  // clockwise
  };
  std::string read_target(const mavlink::Message& message, const Vehicle& vehicle, bool is_global);
  std::string read_attitude(const mavlink::Message& message, const Vehicle& vehicle);
  void note(SimTime now);
  uav::Setpoint setpoint_of(const Target& target, const Vehicle& vehicle) const;

  std::optional<uav::Setpoint> direct_;  // attitude or rates, with thrust
  Target target_;
  std::optional<SimTime> stream_since_;
  std::optional<SimTime> last_at_;
};

}  // namespace tether::autopilot
