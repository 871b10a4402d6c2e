#include "navigator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <tether/base/units.h>

namespace tether::autopilot {
namespace {

using uav::Vec3;

constexpr double kSlowDescentBelow_m = 5.0;
// The reference of a descent is not deeper below the vehicle, so that it does not run into the
// ground.
constexpr double kMostLead_m = 0.6;
// What is taken for standing on the ground: it should sink, and does not, for so long. What it
// stands on may move.
constexpr double kSinking_m = 0.2, kSinking_m_s = 0.2, kStill_m_s = 0.15, kCarried_m_s = 1.5;
constexpr double kSinking_m_s2 = 0.5;
constexpr Duration kStillFor = std::chrono::milliseconds(500);
// It should leave the ground, or has.
constexpr double kRise_m = 0.1, kRise_m_s = 0.05, kRisen_m = 0.05, kRisen_m_s = 0.15;
constexpr double kIdleRotors = 0.15;  // share of their greatest speed
constexpr double kBrakingShare = 0.5;
constexpr double kArrived_m = 0.3;
constexpr double kHeadsFrom_m = 1.0;  // nearer goals do not change the heading

double horizontal(const Vec3& v) {
  return std::hypot(v.x, v.y);
}

bool is_acceleration(const uav::Setpoint& setpoint) {
  return uav::level_of(setpoint.mask) == uav::SetpointLevel::kAcceleration;
}

// From which it can stop within the distance.
double speed_for(double distance, double most, double acceleration) {
  constexpr double kGain_1_s = 4.0;
  return std::min(
      {most, std::sqrt(2.0 * kBrakingShare * acceleration * distance), kGain_1_s * distance});
}

}  // namespace

void Navigator::go_to(const Vec3& p_W, double yaw_W_rad) {
  goal_W_ = p_W;
  if (std::isfinite(yaw_W_rad)) goal_yaw_rad_ = yaw_W_rad;
}

void Navigator::set_cruise(double speed_m_s) {
  const ParameterInfo& limits = info_of(Parameter::kCruise_m_s);
  cruise_m_s_ = std::clamp(speed_m_s, limits.min, limits.max);
}

// Where it stops if it brakes now.
void Navigator::stop_here(const Vehicle& vehicle) {
  const double braking = kBrakingShare * vehicle.parameter(Parameter::kAcceleration_m_s2);
  reference_W_ = vehicle.estimate.p_WB;
  velocity_W_m_s_ = vehicle.is_landed ? Vec3{} : vehicle.estimate.v_WB;
  const Vec3& v = velocity_W_m_s_;
  const double along_s = horizontal(v) / (2.0 * braking), up_s = std::abs(v.z) / (2.0 * braking);
  goal_W_ = reference_W_ + Vec3{along_s * v.x, along_s * v.y, up_s * v.z};
  yaw_rad_ = goal_yaw_rad_ = uav::yaw_rad(vehicle.estimate.q_WB);
  is_descending_ = false;
}

void Navigator::begin(const Vehicle& vehicle, Missions& missions) {
  stop_here(vehicle);
  if (const auto stay_W = std::exchange(stay_W_, std::nullopt);
      stay_W && vehicle.mode == Mode::kHold)
    goal_W_ = *stay_W;
  next_mode_.reset();
  item_.reset();
  item_until_.reset();
  cruise_m_s_.reset();
  if (vehicle.mode == Mode::kTakeoff) {
    goal_W_.z = std::max(
        goal_W_.z,
        takeoff_z_W_.value_or(vehicle.home_W.z + vehicle.parameter(Parameter::kTakeoffAltitude_m)));
  } else {
    takeoff_z_W_.reset();
  }
  if (vehicle.mode == Mode::kLand) is_descending_ = true;
  if (vehicle.mode == Mode::kReturn) {
    const bool is_near = horizontal(vehicle.home_W - vehicle.estimate.p_WB) <
                         vehicle.parameter(Parameter::kReturnMinDistance_m);
    return_phase_ = is_near ? ReturnPhase::kFly : ReturnPhase::kClimb;
  }
  if (vehicle.mode == Mode::kMission && missions.is_at_end()) missions.restart();
}

void Navigator::stay_at_goal() {
  next_mode_ = Mode::kHold;
  stay_W_ = goal_W_;
}

std::optional<Mode> Navigator::next_mode() {
  return std::exchange(next_mode_, std::nullopt);
}

Navigator::Speeds Navigator::speeds(const Vehicle& vehicle) const {
  const double cruise = cruise_m_s_.value_or(vehicle.parameter(Parameter::kCruise_m_s));
  if (vehicle.mode == Mode::kTakeoff) {
    const double up = vehicle.parameter(Parameter::kTakeoffSpeed_m_s);
    return {cruise, up, up};
  }
  const bool is_low =
      is_descending_ && vehicle.estimate.p_WB.z - vehicle.home_W.z < kSlowDescentBelow_m;
  return {cruise, vehicle.parameter(Parameter::kUp_m_s),
          vehicle.parameter(is_low ? Parameter::kLandSpeed_m_s : Parameter::kDown_m_s)};
}

void Navigator::move(const Vehicle& vehicle, const Speeds& speeds, double dt_s) {
  const double acceleration = vehicle.parameter(Parameter::kAcceleration_m_s2);
  const Vec3 way = goal_W_ - reference_W_;
  const double distance = horizontal(way);
  const double along =
      distance > 0.0 ? speed_for(distance, speeds.horizontal_m_s, acceleration) / distance : 0.0;
  const double up = std::copysign(
      speed_for(std::abs(way.z), way.z > 0.0 ? speeds.up_m_s : speeds.down_m_s, acceleration),
      way.z);
  Vec3 change = Vec3{along * way.x, along * way.y, up} - velocity_W_m_s_;
  const double most = acceleration * dt_s,
               share = std::min(1.0, most / std::max(most, horizontal(change)));
  velocity_W_m_s_ =
      velocity_W_m_s_ + Vec3{share * change.x, share * change.y, std::clamp(change.z, -most, most)};
  reference_W_ = reference_W_ + dt_s * velocity_W_m_s_;
}

void Navigator::turn(const Vehicle& vehicle, double dt_s) {
  const double most = rad_from_deg(vehicle.parameter(Parameter::kYawRate_deg_s)) * dt_s;
  yaw_rad_ += std::clamp(wrap_angle_rad(goal_yaw_rad_ - yaw_rad_), -most, most);
}

void Navigator::head_for_goal() {
  const Vec3 way = goal_W_ - reference_W_;
  if (horizontal(way) > kHeadsFrom_m) goal_yaw_rad_ = std::atan2(way.y, way.x);
}

void Navigator::descend(const Vehicle& vehicle) {
  is_descending_ = true;
  goal_W_.z = vehicle.estimate.p_WB.z - 1e3;
}

bool Navigator::is_at_goal(const Vehicle& vehicle, double radius_m) const {
  const Vec3 way = goal_W_ - vehicle.estimate.p_WB;
  return horizontal(way) < radius_m &&
         std::abs(way.z) < std::min(radius_m, vehicle.parameter(Parameter::kAltitudeAcceptance_m));
}

void Navigator::return_home(const Vehicle& vehicle) {
  const double height = vehicle.estimate.p_WB.z - vehicle.home_W.z;
  switch (return_phase_) {
    case ReturnPhase::kClimb:
      goal_W_.z =
          std::max(goal_W_.z, vehicle.home_W.z + vehicle.parameter(Parameter::kReturnAltitude_m));
      if (goal_W_.z - vehicle.estimate.p_WB.z < kArrived_m) return_phase_ = ReturnPhase::kFly;
      break;
    case ReturnPhase::kFly:
      goal_W_ = {vehicle.home_W.x, vehicle.home_W.y, goal_W_.z};
      head_for_goal();
      if (horizontal(goal_W_ - vehicle.estimate.p_WB) < kArrived_m)
        return_phase_ = ReturnPhase::kDescend;
      break;
    case ReturnPhase::kDescend:
      goal_W_.z =
          std::min(goal_W_.z, vehicle.home_W.z + vehicle.parameter(Parameter::kReturnDescend_m));
      goal_yaw_rad_ = vehicle.home_yaw_W_rad;
      if (height - vehicle.parameter(Parameter::kReturnDescend_m) < kArrived_m)
        return_phase_ = ReturnPhase::kLand;
      break;
    case ReturnPhase::kLand:
      descend(vehicle);
      break;
  }
}

void Navigator::begin_item(const Vehicle& vehicle, const MissionItem& item) {
  item_until_.reset();
  is_descending_ = false;
  if (item.command == kChangeSpeed) {
    if (item.parameters[1] > 0.0) set_cruise(item.parameters[1]);
    return;
  }
  if (item.command == kDelay || item.command == kReturnToLaunch) return;
  const bool is_relative = item.frame == 3 || item.frame == 6;
  sim::Geodetic place = vehicle.frame.geodetic(reference_W_);
  place.altitude_m =
      item.z_m + (is_relative ? vehicle.frame.geodetic(vehicle.home_W).altitude_m : 0.0);
  const bool is_elsewhere = (item.latitude_deg != 0.0 || item.longitude_deg != 0.0) &&
                            !(item.command == kTakeoffItem && vehicle.is_landed);
  if (is_elsewhere) {
    place.latitude_deg = item.latitude_deg;
    place.longitude_deg = item.longitude_deg;
  }
  goal_W_ = vehicle.frame.point(place);
  if (item.command == kLandItem) goal_W_.z = reference_W_.z;
  if (std::isfinite(item.parameters[3]) && item.command == kWaypoint && item.parameters[3] != 0.0) {
    goal_yaw_rad_ = vehicle.frame.yaw_from_ned(rad_from_deg(item.parameters[3]));
  } else {
    head_for_goal();
  }
}

// An item is begun, reached, and held for as long as it says.
void Navigator::fly_mission(Vehicle& vehicle, Missions& missions, Outbox& outbox) {
  if (missions.is_at_end()) {
    if (!vehicle.is_landed) stay_at_goal();
    return;
  }
  const MissionItem& item = missions.items()[missions.current().item];
  if (item_ != missions.current()) {
    item_ = missions.current();
    begin_item(vehicle, item);
  }
  const double radius = item.command == kWaypoint && item.parameters[1] > 0.0
                            ? item.parameters[1]
                            : vehicle.parameter(Parameter::kAcceptance_m);
  switch (item.command) {
    case kReturnToLaunch:
      next_mode_ = Mode::kReturn;
      return;
    case kLoiterUnlimited:
      return;
    case kLandItem:
      if (horizontal(goal_W_ - vehicle.estimate.p_WB) < kArrived_m) descend(vehicle);
      if (!vehicle.is_landed) return;
      break;
    case kDelay:
    case kChangeSpeed:
      break;
    default:
      if (!item_until_ && !is_at_goal(vehicle, radius)) return;
  }
  if (!item_until_) {
    const bool is_held =
        item.command == kWaypoint || item.command == kLoiterTime || item.command == kDelay;
    const double held_s = is_held && item.parameters[0] > 0.0 ? item.parameters[0] : 0.0;
    item_until_ = vehicle.now + duration_from_seconds(std::min(held_s, 1e5));
  }
  if (vehicle.now < *item_until_) return;
  missions.say_reached(outbox);
  if (!item.goes_on) {
    item_until_ = SimTime::max();
    return;
  }
  item_.reset();
  if (!missions.go_on(outbox)) {
    outbox.say(6, "mission finished");
    if (!vehicle.is_landed) stay_at_goal();
  }
}

uav::Setpoint Navigator::follow_reference() const {
  uav::Setpoint setpoint;
  setpoint.mask = uav::kPosition | uav::kVelocity | uav::kYaw;
  setpoint.in_heading = false;
  setpoint.p_WB_m = reference_W_;
  setpoint.velocity_m_s = velocity_W_m_s_;
  setpoint.yaw_rad = yaw_rad_;
  return setpoint;
}

// On the ground it stays there until it should rise; in the air it has landed when it should sink,
// or is disarmed, and does not sink.
void Navigator::watch_ground(Vehicle& vehicle, const uav::Setpoint& wanted, Outbox& outbox) {
  const uav::BodyState& body = vehicle.estimate;
  const double below_m = wanted.has(uav::kPosition) ? body.p_WB.z - wanted.p_WB_m.z : 0.0;
  const double sinking_m_s =
      wanted.has(uav::kPosition) || !wanted.has(uav::kVelocity) ? 0.0 : -wanted.velocity_m_s.z;
  const bool should_sink =
      !vehicle.is_armed || below_m > kSinking_m || sinking_m_s > kSinking_m_s ||
      (is_acceleration(wanted) && wanted.acceleration_m_s2.z < -kSinking_m_s2) ||
      (wanted.has(uav::kThrust) && wanted.thrust_N < 0.5 * vehicle.hover_thrust_N);
  const bool is_still = std::abs(body.v_WB.z) < kStill_m_s && horizontal(body.v_WB) < kCarried_m_s;
  if (vehicle.is_landed) {
    const bool has_risen = body.v_WB.z > kRisen_m_s || body.p_WB.z > ground_z_W_ + kRisen_m;
    if (has_risen && vehicle.is_armed && should_rise(vehicle, wanted)) {
      vehicle.is_landed = false;
      vehicle.landed_at.reset();
      outbox.say(6, "took off");
    }
    return;
  }
  if (!should_sink || !is_still) {
    still_since_.reset();
    return;
  }
  if (!still_since_) still_since_ = vehicle.now;
  if (vehicle.now - *still_since_ < kStillFor) return;
  vehicle.is_landed = true;
  vehicle.landed_at = vehicle.now;
  outbox.say(6, "landed");
}

// The reference of automatic modes rises if it should; the estimate may drift.
bool Navigator::should_rise(const Vehicle& vehicle, const uav::Setpoint& wanted) const {
  if (vehicle.mode != Mode::kOffboard) return velocity_W_m_s_.z > kRise_m_s;
  if (wanted.has(uav::kPosition)) return wanted.p_WB_m.z > vehicle.estimate.p_WB.z + kRise_m;
  if (wanted.has(uav::kVelocity)) return wanted.velocity_m_s.z > kRise_m_s;
  if (wanted.has(uav::kThrust)) return wanted.thrust_N > vehicle.hover_thrust_N;
  return is_acceleration(wanted) && wanted.acceleration_m_s2.z > kRise_m_s;
}

uav::Setpoint Navigator::step(Vehicle& vehicle, Missions& missions, const Offboard& offboard,
                              Duration dt, Outbox& outbox) {
  const double dt_s = to_seconds(dt);
  uav::Setpoint wanted;
  if (vehicle.mode == Mode::kOffboard && offboard.has_setpoint()) {
    wanted = offboard.setpoint(vehicle);
  } else {
    if (vehicle.mode == Mode::kLand) descend(vehicle);
    if (vehicle.mode == Mode::kReturn) return_home(vehicle);
    if (vehicle.mode == Mode::kMission && vehicle.is_armed) fly_mission(vehicle, missions, outbox);
    if (vehicle.is_armed) {
      move(vehicle, speeds(vehicle), dt_s);
      turn(vehicle, dt_s);
    }
    if (is_descending_)
      reference_W_.z = std::max(reference_W_.z, vehicle.estimate.p_WB.z - kMostLead_m);
    wanted = follow_reference();
    if (vehicle.mode == Mode::kTakeoff && vehicle.is_armed && is_at_goal(vehicle, kArrived_m))
      stay_at_goal();
  }
  watch_ground(vehicle, wanted, outbox);
  if (vehicle.is_armed && (!vehicle.is_landed || should_rise(vehicle, wanted))) return wanted;

  // On the ground: rotors stand, or idle until it should rise.
  ground_z_W_ = vehicle.estimate.p_WB.z;
  uav::Setpoint idle;
  idle.mask = uav::kRotorSpeeds;
  idle.in_heading = false;
  idle.rotor_speeds_rad_s.assign(
      vehicle.limits.rotors,
      vehicle.is_armed ? kIdleRotors * vehicle.limits.max_rotor_speed_rad_s : 0.0);
  return idle;
}

}  // namespace tether::autopilot
