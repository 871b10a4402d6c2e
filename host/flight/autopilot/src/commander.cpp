#include "commander.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <tether/base/units.h>

namespace tether::autopilot {
namespace {

using command_result::kAccepted;
using command_result::kDenied;
using command_result::kFailed;
using command_result::kRejected;
using command_result::kUnsupported;

// MAV_CMD.
constexpr int kNavLoiter = 17, kNavReturn = 20, kNavLand = 21, kNavTakeoff = 22, kDoSetMode = 176,
              kDoChangeSpeed = 178, kDoSetHome = 179, kDoReposition = 192, kMissionStart = 300,
              kArmDisarm = 400, kGetHome = 410, kGetInterval = 510, kSetInterval = 511,
              kRequestMessage = 512, kRequestCapabilities = 520;

constexpr double kForce = 21196.0;  // parameter 2 of kArmDisarm: without checks

// Parameters that are not numbers ask for what is there already.
bool is_none_or_place(const Command& command) {
  const auto or_0 = [](double value) { return std::isnan(value) ? 0.0 : value; };
  return is_place(or_0(command.p[5]), or_0(command.p[6]), or_0(command.p[7]));
}
const mavlink::MessageType* type_of(double id) {
  return whole(id) < 0 ? nullptr : mavlink::find_type(static_cast<std::uint32_t>(whole(id)));
}

struct BatteryLevel {
  Parameter threshold;
  int severity;
  const char* text;
};
constexpr BatteryLevel kBatteryLevels[] = {
    {Parameter::kBatLow, 4, "battery is low"},
    {Parameter::kBatCritical, 2, "battery is critical"},
    {Parameter::kBatEmergency, 2, "battery is almost empty"},
};

}  // namespace

bool Commander::takes(const mavlink::Message& message) {
  return is_command(message) || message.is("SET_MODE");
}

void Commander::on_message(const mavlink::Frame& frame) {
  const mavlink::Message& m = frame.message;
  if (m.is("SET_MODE")) {
    const auto custom = static_cast<unsigned>(m.integer("custom_mode"));
    set_mode(m.integer("base_mode"), custom >> 16 & 0xFFU, custom >> 24);
    return;
  }
  const Command command = to_command(m);
  outbox_->send(acknowledgement(command, run(command), frame.from));
}

int Commander::run(const Command& command) {
  if (vehicle_->mount.takes(command)) return vehicle_->mount.run(command);
  const auto& p = command.p;
  switch (command.id) {
    case kArmDisarm:
      return set_arming(command);
    case kDoSetMode:
      return set_mode(whole(p[1]), whole(p[2]), whole(p[3]));
    case kNavTakeoff:
      return take_off(command);
    case kNavLand:
      return ask_for(Mode::kLand);
    case kNavReturn:
      return ask_for(Mode::kReturn);
    case kNavLoiter:
      return ask_for(Mode::kHold);
    case kMissionStart:
      return start_mission(command);
    case kDoReposition:
      return reposition(command);
    case kDoChangeSpeed:
      if (!(p[2] > 0.0 && std::isfinite(p[2]))) return kDenied;
      navigator_->set_cruise(p[2]);
      return kAccepted;
    case kDoSetHome:
      return set_home(command);
    case kGetHome:
      telemetry_->request("HOME_POSITION");
      return kAccepted;
    case kSetInterval:
      return set_interval(command);
    case kGetInterval: {
      const auto* type = type_of(p[1]);
      return type != nullptr && telemetry_->tell_interval(*type, *outbox_) ? kAccepted : kFailed;
    }
    case kRequestMessage: {
      const auto* type = type_of(p[1]);
      return type != nullptr && telemetry_->request(type->name) ? kAccepted : kDenied;
    }
    case kRequestCapabilities:
      telemetry_->request("AUTOPILOT_VERSION");
      return kAccepted;
    default:
      return kUnsupported;
  }
}

std::string Commander::why_not_arm() const {
  if (!vehicle_->is_landed) return "it is in the air";
  if (battery_state_ > 0) return "the battery is low";
  if (vehicle_->mode == Mode::kLand || vehicle_->mode == Mode::kReturn)
    return fmt::format("not in {}", info(vehicle_->mode).name);
  return why_not(vehicle_->mode);
}

int Commander::set_arming(const Command& command) {
  const bool is_forced = command.p[2] == kForce;
  if (command.p[1] == 1.0) return arm(is_forced) ? kAccepted : kRejected;
  if (command.p[1] != 0.0) return kUnsupported;
  if (!vehicle_->is_armed) return kAccepted;
  if (!vehicle_->is_landed && !is_forced) {
    outbox_->say(2, "Disarming denied: it is not landed");
    return kRejected;
  }
  disarm("by command");
  return kAccepted;
}

// Home is where it was armed.
bool Commander::arm(bool is_forced) {
  if (vehicle_->is_armed) return true;
  if (const std::string why = why_not_arm(); !is_forced && !why.empty()) {
    outbox_->say(2, "Arming denied: " + why);
    return false;
  }
  vehicle_->is_armed = true;
  vehicle_->armed_at = vehicle_->now;
  vehicle_->landed_at.reset();
  vehicle_->home_W = vehicle_->estimate.p_WB;
  vehicle_->home_yaw_W_rad = uav::yaw_rad(vehicle_->estimate.q_WB);
  outbox_->say(6, "armed");
  telemetry_->request("HOME_POSITION");
  telemetry_->request("HEARTBEAT");
  navigator_->begin(*vehicle_, *missions_);
  return true;
}

void Commander::disarm(std::string_view why) {
  vehicle_->is_armed = false;
  vehicle_->is_failsafe = false;
  outbox_->say(6, fmt::format("disarmed {}", why));
  telemetry_->request("HEARTBEAT");
  if (vehicle_->mode == Mode::kLand || vehicle_->mode == Mode::kReturn ||
      vehicle_->mode == Mode::kTakeoff)
    enter(Mode::kHold);
}

// Empty: it can be entered.
std::string Commander::why_not(Mode mode) const {
  if (mode == Mode::kOffboard && !offboard_->is_streaming(vehicle_->now))
    return "OFFBOARD needs set-points at 2 Hz or more, for a second before";
  if (mode == Mode::kMission && missions_->items().empty()) return "there is no mission";
  return {};
}

int Commander::set_mode(std::int64_t base_mode, std::int64_t main, std::int64_t sub) {
  constexpr std::int64_t kCustom = 1;
  const auto mode = base_mode < 0 || (base_mode & kCustom) == 0 ? std::nullopt : mode_of(main, sub);
  if (!mode) {
    outbox_->say(2, fmt::format("mode {}.{} is not available", main, sub));
    return kRejected;
  }
  return change_to(*mode);
}

// What a mode needs is looked at in the air, and before arming.
int Commander::change_to(Mode mode) {
  if (const std::string why = why_not(mode); vehicle_->is_armed && !why.empty()) {
    outbox_->say(2, fmt::format("{} denied: {}", info(mode).name, why));
    return kRejected;
  }
  return ask_for(mode);
}

// To ask again for what it does already changes nothing, as in PX4: programs repeat their requests.
int Commander::ask_for(Mode mode) {
  if (!vehicle_->is_armed || vehicle_->mode != mode) enter(mode);
  vehicle_->is_failsafe = false;
  return kAccepted;
}

// It arms, too.
int Commander::start_mission(const Command& command) {
  const double first = command.p[1];
  if (missions_->items().empty()) {
    outbox_->say(2, "Mission start denied: there is no mission");
    return kDenied;
  }
  const auto count = static_cast<double>(missions_->items().size());
  if (!(first >= -1.0 && first < count)) return kDenied;
  if (first > 0.0) missions_->go_to(static_cast<std::size_t>(first));
  enter(Mode::kMission);
  return arm() ? kAccepted : kRejected;
}

void Commander::enter(Mode mode) {
  vehicle_->mode = mode;
  vehicle_->is_failsafe = false;
  navigator_->begin(*vehicle_, *missions_);
  telemetry_->request("HEARTBEAT");
}

double Commander::altitude_w(const Command& command) const {
  if (!std::isfinite(command.p[7])) return command.p[7];
  const double altitude_m =
      command.p[7] +
      (command.is_place_relative ? vehicle_->frame.geodetic(vehicle_->home_W).altitude_m : 0.0);
  sim::Geodetic here = vehicle_->frame.geodetic(vehicle_->estimate.p_WB);
  here.altitude_m = altitude_m;
  return vehicle_->frame.point(here).z;
}

// An altitude that is not above the vehicle is replaced by that of the parameter.
int Commander::take_off(const Command& command) {
  if (!is_none_or_place(command)) return kDenied;
  const double z_W = altitude_w(command);
  const bool is_above = std::isfinite(z_W) && z_W > vehicle_->estimate.p_WB.z;
  navigator_->take_off_to(is_above ? std::optional(z_W) : std::nullopt);
  enter(Mode::kTakeoff);
  return kAccepted;
}

// Parameter 2 must ask for the change of mode.
int Commander::reposition(const Command& command) {
  if (whole(command.p[2]) != 1) return kUnsupported;
  if (!is_none_or_place(command)) return kDenied;
  if (!vehicle_->is_armed || vehicle_->is_landed) return kRejected;
  enter(Mode::kHold);
  uav::Vec3 p_W = vehicle_->estimate.p_WB;
  const double z_W = altitude_w(command);
  if (is_place(command.p[5], command.p[6], 0.0) && (command.p[5] != 0.0 || command.p[6] != 0.0)) {
    sim::Geodetic place = vehicle_->frame.geodetic(p_W);
    place.latitude_deg = command.p[5];
    place.longitude_deg = command.p[6];
    p_W = vehicle_->frame.point(place);
  }
  if (std::isfinite(z_W)) p_W.z = z_W;
  if (command.p[1] > 0.0) navigator_->set_cruise(command.p[1]);
  navigator_->go_to(p_W, vehicle_->frame.yaw_from_ned(command.p[4]));
  return kAccepted;
}

int Commander::set_interval(const Command& command) {
  const auto* type = type_of(command.p[1]);
  return type != nullptr && telemetry_->set_interval(type->name, command.p[2]) ? kAccepted
                                                                               : kFailed;
}

int Commander::set_home(const Command& command) {
  if (command.p[1] > 0.5) {
    vehicle_->home_W = vehicle_->estimate.p_WB;
  } else {
    if (!is_place(command.p[5], command.p[6], command.p[7])) return kDenied;
    vehicle_->home_W = vehicle_->frame.point({command.p[5], command.p[6], command.p[7]});
  }
  telemetry_->request("HOME_POSITION");
  return kAccepted;
}

void Commander::step() {
  if (const auto next = navigator_->next_mode()) enter(*next);
  watch_set_points();
  watch_battery();
  watch_ground();
}

void Commander::watch_set_points() {
  if (vehicle_->mode != Mode::kOffboard || !vehicle_->is_armed ||
      !offboard_->is_lost(vehicle_->now, vehicle_->time_parameter(Parameter::kOffboardLoss_s)))
    return;
  const int action = static_cast<int>(vehicle_->parameter(Parameter::kOffboardLossAction));
  const Mode mode = action == 3 ? Mode::kReturn : action == 4 ? Mode::kLand : Mode::kHold;
  enter(mode);
  vehicle_->is_failsafe = true;
  outbox_->say(2, fmt::format("no set-points: {}", info(mode).name));
}

void Commander::watch_battery() {
  if (!vehicle_->battery) return;
  int state = 0;
  for (const BatteryLevel& level : kBatteryLevels)
    state += vehicle_->battery->charge < vehicle_->parameter(level.threshold) ? 1 : 0;
  if (state <= battery_state_) return;
  battery_state_ = state;
  const BatteryLevel& level = kBatteryLevels[state - 1];
  outbox_->say(level.severity, level.text);
  const int action = static_cast<int>(vehicle_->parameter(Parameter::kLowBatteryAction));
  if (!vehicle_->is_armed || vehicle_->is_landed || action == 0) return;
  if (state < 2) return;
  const Mode mode = state == 2 && action != 2 ? Mode::kReturn : Mode::kLand;
  if (vehicle_->mode != Mode::kLand) enter(mode);
  vehicle_->is_failsafe = true;
}

void Commander::watch_ground() {
  if (!vehicle_->is_armed || !vehicle_->is_landed) return;
  const bool has_landed = vehicle_->landed_at.has_value();
  const Parameter limit = has_landed ? Parameter::kDisarmLanded_s : Parameter::kDisarmPreflight_s;
  if (vehicle_->parameter(limit) < 0.0) return;
  const SimTime since = has_landed ? *vehicle_->landed_at : vehicle_->armed_at;
  if (vehicle_->now - since >= vehicle_->time_parameter(limit))
    disarm(has_landed ? "after landing" : "because it did not take off");
}

}  // namespace tether::autopilot
