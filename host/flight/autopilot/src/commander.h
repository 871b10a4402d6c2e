#pragma once

#include "command.h"
#include "missions.h"
#include "navigator.h"
#include "offboard.h"
#include "outbox.h"
#include "telemetry.h"
#include "vehicle.h"

#include <cstdint>
#include <string>
#include <string_view>

#include <tether/mavlink/frame.h>

namespace tether::autopilot {

/// Arming, modes, commands and failsafes.
class Commander {
 public:
  Commander(Vehicle& vehicle, Navigator& navigator, Missions& missions, Offboard& offboard,
            Telemetry& telemetry, Outbox& outbox)
      : vehicle_(&vehicle),
        navigator_(&navigator),
        missions_(&missions),
        offboard_(&offboard),
        telemetry_(&telemetry),
        outbox_(&outbox) {}

  /// COMMAND_LONG, COMMAND_INT and SET_MODE.
  static bool takes(const mavlink::Message& message);
  void on_message(const mavlink::Frame& frame);
  /// Whatever time brings: lost set-points, an empty battery, disarming.
  void step();

 private:
  int run(const Command& command);
  int ask_for(Mode mode);
  void enter(Mode mode);
  int set_arming(const Command& command);
  int set_mode(std::int64_t base_mode, std::int64_t main, std::int64_t sub);
  int change_to(Mode mode);
  int start_mission(const Command& command);
  int take_off(const Command& command);
  int reposition(const Command& command);
  int set_interval(const Command& command);
  int set_home(const Command& command);
  std::string why_not_arm() const;
  std::string why_not(Mode mode) const;
  /// False: it is denied, and the reason told.
  bool arm(bool is_forced = false);
  void disarm(std::string_view why);
  void watch_set_points();
  void watch_battery();
  void watch_ground();
  double altitude_w(const Command& command) const;

  Vehicle* vehicle_;
  Navigator* navigator_;
  Missions* missions_;
  Offboard* offboard_;
  Telemetry* telemetry_;
  Outbox* outbox_;
  int battery_state_ = 0;  // 0 good, 1 low, 2 critical, 3 emergency
};

}  // namespace tether::autopilot
