#pragma once

#include <tether/mavlink/frame.h>
#include <tether/sim/geodesy.h>

namespace tether::autopilot {

/// The controller's frames: its local frame L is NED, with its origin where the vehicle was when
/// it started, as a state estimator's.
class LocalFrame {
 public:
  LocalFrame() = default;
  LocalFrame(const sim::Place& place, const uav::Vec3& p_WL) : place_(place), p_WL_(p_WL) {}

  const uav::Vec3& origin() const { return p_WL_; }  ///< in W
  uav::Vec3 to_ned(const uav::Vec3& v_W) const {
    return mavlink::ned_from_enu(sim::to_enu(place_, v_W));
  }
  uav::Vec3 from_ned(const uav::Vec3& v_L) const {
    return sim::from_enu(place_, mavlink::enu_from_ned(v_L));
  }
  uav::Vec3 point_to_ned(const uav::Vec3& p_W) const { return to_ned(p_W - p_WL_); }
  uav::Vec3 point_from_ned(const uav::Vec3& p_L) const { return p_WL_ + from_ned(p_L); }
  sim::Geodetic geodetic(const uav::Vec3& p_W) const { return sim::geodetic_of(place_, p_W); }
  uav::Vec3 point(const sim::Geodetic& point) const { return sim::point_of(place_, point); }
  /// Attitude of FRD in NED, of FLU in W, and back.
  uav::Quat attitude_to_ned(const uav::Quat& q_WB) const {
    return mavlink::ned_from_enu(turn(-place_.heading_rad) * q_WB);
  }
  uav::Quat attitude_from_ned(const uav::Quat& q_L) const {
    return turn(place_.heading_rad) * mavlink::enu_from_ned(q_L);
  }
  /// Yaw in W, counter-clockwise from its x, of a yaw clockwise from north, and back.
  double yaw_from_ned(double yaw_rad) const {
    return mavlink::enu_from_ned_yaw(yaw_rad) + place_.heading_rad;
  }
  double yaw_to_ned(double yaw_W_rad) const {
    return mavlink::ned_from_enu_yaw(yaw_W_rad - place_.heading_rad);
  }

 private:
  static uav::Quat turn(double yaw_rad) { return uav::from_axis_angle({0, 0, 1}, yaw_rad); }

  sim::Place place_{};
  uav::Vec3 p_WL_{};
};

}  // namespace tether::autopilot
