#pragma once

#include "missions.h"
#include "offboard.h"
#include "outbox.h"
#include "vehicle.h"

#include <optional>

#include <tether/uav/setpoint.h>

namespace tether::autopilot {

/// Where the vehicle should go in each mode. In automatic modes, a reference moves to the goal
/// within the limits of the parameters, and the vehicle follows it.
class Navigator {
 public:
  /// A mode begins.
  void begin(const Vehicle& vehicle, Missions& missions);
  /// Of the mode AUTO.TAKEOFF, until another mode begins: the altitude in W; none: that of the
  /// parameter.
  void take_off_to(std::optional<double> z_W_m) { takeoff_z_W_ = z_W_m; }
  /// Of the mode AUTO.LOITER: another place. A yaw that is not finite is kept.
  void go_to(const uav::Vec3& p_W, double yaw_W_rad);
  /// Until the next mode begins; brought within the limits of the parameter.
  void set_cruise(double speed_m_s);

  /// One step of so long: what to follow. Tells landings and waypoints, and may end the mode: then
  /// `next_mode` says with which one to go on.
  uav::Setpoint step(Vehicle& vehicle, Missions& missions, const Offboard& offboard, Duration dt,
                     Outbox& outbox);
  std::optional<Mode> next_mode();

 private:
  struct Speeds {
    double horizontal_m_s, up_m_s, down_m_s;
  };
  enum class ReturnPhase { kClimb, kFly, kDescend, kLand };

  Speeds speeds(const Vehicle& vehicle) const;
  void stop_here(const Vehicle& vehicle);
  void move(const Vehicle& vehicle, const Speeds& speeds, double dt_s);
  void turn(const Vehicle& vehicle, double dt_s);
  void head_for_goal();
  /// The mode has come to its end: Hold, at the goal.
  void stay_at_goal();
  void descend(const Vehicle& vehicle);
  bool is_at_goal(const Vehicle& vehicle, double radius_m) const;
  void return_home(const Vehicle& vehicle);
  void fly_mission(Vehicle& vehicle, Missions& missions, Outbox& outbox);
  void begin_item(const Vehicle& vehicle, const MissionItem& item);
  void watch_ground(Vehicle& vehicle, const uav::Setpoint& wanted, Outbox& outbox);
  uav::Setpoint follow_reference() const;
  bool should_rise(const Vehicle& vehicle, const uav::Setpoint& wanted) const;

  uav::Vec3 goal_W_;
  double goal_yaw_rad_ = 0.0;
  uav::Vec3 reference_W_;
  uav::Vec3 velocity_W_m_s_;
  double yaw_rad_ = 0.0;
  bool is_descending_ = false;
  std::optional<double> takeoff_z_W_;
  double ground_z_W_ = 0.0;  // where it stood last
  std::optional<double> cruise_m_s_;
  ReturnPhase return_phase_ = ReturnPhase::kClimb;
  std::optional<MissionPlace> item_;   // that is flown
  std::optional<SimTime> item_until_;  // it was reached, and is held until then
  std::optional<SimTime> still_since_;
  std::optional<Mode> next_mode_;
  std::optional<uav::Vec3> stay_W_;  // of the next mode
};

}  // namespace tether::autopilot
