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
// What is taken for standing on the ground: it should sink, and does not move for so long.
constexpr double kSinking_m = 0.2, kSinking_m_s = 0.2, kStill_m_s = 0.15;
constexpr Duration kStillFor = std::chrono::milliseconds(500);
// It has left the ground.
constexpr double kRisen_m_s = 0.15;
constexpr double kIdleRotors = 0.15;  // share of their greatest speed
constexpr double kBrakingShare = 0.5;
constexpr double kArrived_m = 0.3;
constexpr double kHeadsFrom_m = 1.0;  // nearer goals do not change the heading

double horizontal(const Vec3& v) {
  return std::hypot(v.x, v.y);
}

// A speed that grows with `acceleration`, and can stop within the distance.
double next_speed(double speed, double most, double distance, double acceleration, double dt_s) {
  const double stopping = std::sqrt(2.0 * kBrakingShare * acceleration * std::max(0.0, distance));
  return std::min({speed + acceleration * dt_s, most, stopping});
}

}  // namespace

void Navigator::go_to(const Vec3& p_W, double yaw_W_rad) {
  goal_W_ = p_W;
  if (std::isfinite(yaw_W_rad)) goal_yaw_rad_ = yaw_W_rad;
}

// Where it stops if it brakes now.
void Navigator::stop_here(const Vehicle& vehicle) {
  const Vec3& v = vehicle.estimate.v_WB;
  const double braking = kBrakingShare * vehicle.parameter(Parameter::kAcceleration_m_s2);
  const double distance_s = horizontal(v) / (2.0 * braking);
  reference_W_ = vehicle.estimate.p_WB;
  velocity_W_m_s_ = vehicle.is_landed ? Vec3{} : v;
  goal_W_ = reference_W_ + distance_s * Vec3{velocity_W_m_s_.x, velocity_W_m_s_.y, 0.0};
  yaw_rad_ = goal_yaw_rad_ = uav::yaw_rad(vehicle.estimate.q_WB);
  is_descending_ = false;
}

void Navigator::begin(const Vehicle& vehicle, Missions& missions) {
  stop_here(vehicle);
  item_.reset();
  item_until_.reset();
  cruise_m_s_.reset();
  if (vehicle.mode == Mode::kTakeoff) {
    goal_W_ = reference_W_;
    goal_W_.z = std::isfinite(takeoff_z_W_) && has_takeoff_z_
                    ? takeoff_z_W_
                    : vehicle.home_W.z + vehicle.parameter(Parameter::kTakeoffAltitude_m);
  }
  has_takeoff_z_ = false;
  if (vehicle.mode == Mode::kLand) is_descending_ = true;
  if (vehicle.mode == Mode::kReturn) {
    const bool is_near = horizontal(vehicle.home_W - vehicle.estimate.p_WB) <
                         vehicle.parameter(Parameter::kReturnMinDistance_m);
    return_phase_ = is_near ? ReturnPhase::kFly : ReturnPhase::kClimb;
  }
  if (vehicle.mode == Mode::kMission && missions.is_at_end()) missions.restart();
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
  const double speed =
      next_speed(horizontal(velocity_W_m_s_), speeds.horizontal_m_s, distance, acceleration, dt_s);
  const double share = distance > 0.0 ? std::min(1.0, speed * dt_s / distance) : 1.0;
  const double up = std::copysign(
      next_speed(std::abs(velocity_W_m_s_.z), way.z > 0.0 ? speeds.up_m_s : speeds.down_m_s,
                 std::abs(way.z), acceleration, dt_s),
      way.z);
  const Vec3 step{share * way.x, share * way.y,
                  std::abs(up * dt_s) < std::abs(way.z) ? up * dt_s : way.z};
  reference_W_ = reference_W_ + step;
  velocity_W_m_s_ = (1.0 / dt_s) * step;
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
    if (item.parameters[1] > 0.0) cruise_m_s_ = item.parameters[1];
    return;
  }
  const bool is_place = item.command != kDelay && item.command != kReturnToLaunch &&
                        (item.latitude_deg != 0.0 || item.longitude_deg != 0.0);
  if (!is_place) return;
  const bool is_relative = item.frame == 3 || item.frame == 6;
  goal_W_ = vehicle.frame.point({item.latitude_deg, item.longitude_deg, 0.0});
  const double altitude_m =
      item.z_m + (is_relative ? vehicle.frame.geodetic(vehicle.home_W).altitude_m : 0.0);
  goal_W_ = vehicle.frame.point({item.latitude_deg, item.longitude_deg, altitude_m});
  if (item.command == kLandItem) goal_W_.z = reference_W_.z;
  if (item.command == kTakeoffItem && vehicle.is_landed)
    goal_W_ = {reference_W_.x, reference_W_.y, goal_W_.z};
  if (std::isfinite(item.parameters[3]) && item.command == kWaypoint && item.parameters[3] != 0.0) {
    goal_yaw_rad_ = vehicle.frame.yaw_from_ned(rad_from_deg(item.parameters[3]));
  } else {
    head_for_goal();
  }
}

// An item is begun, reached, and held for as long as it says.
void Navigator::fly_mission(Vehicle& vehicle, Missions& missions, Outbox& outbox) {
  if (missions.is_at_end()) {
    next_mode_ = Mode::kHold;
    return;
  }
  const MissionItem& item = missions.items()[missions.current()];
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
  item_.reset();
  if (!missions.reached(outbox)) {
    outbox.say(6, "mission finished");
    if (!vehicle.is_landed) next_mode_ = Mode::kHold;
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
// and does not.
void Navigator::watch_ground(Vehicle& vehicle, const uav::Setpoint& wanted, Outbox& outbox) {
  const uav::BodyState& body = vehicle.estimate;
  const double below_m = wanted.has(uav::kPosition) ? body.p_WB.z - wanted.p_WB_m.z : 0.0;
  const double sinking_m_s =
      wanted.has(uav::kPosition) || !wanted.has(uav::kVelocity) ? 0.0 : -wanted.velocity_m_s.z;
  const bool should_sink =
      below_m > kSinking_m || sinking_m_s > kSinking_m_s ||
      (wanted.has(uav::kThrust) && wanted.thrust_N < 0.5 * vehicle.hover_thrust_N);
  const bool is_still = norm(body.v_WB) < kStill_m_s;
  if (vehicle.is_landed) {
    if (body.v_WB.z > kRisen_m_s && vehicle.is_armed) {
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
      next_mode_ = Mode::kHold;
  }
  watch_ground(vehicle, wanted, outbox);
  if (vehicle.is_armed && !vehicle.is_landed) return wanted;

  // On the ground: rotors stand, or idle until it should rise.
  const bool should_rise =
      (wanted.has(uav::kPosition) && wanted.p_WB_m.z > vehicle.estimate.p_WB.z + 0.02) ||
      (!wanted.has(uav::kPosition) && wanted.has(uav::kVelocity) && wanted.velocity_m_s.z > 0.05) ||
      (wanted.has(uav::kThrust) && wanted.thrust_N > vehicle.hover_thrust_N) ||
      wanted.mask == uav::kAcceleration;
  if (vehicle.is_armed && should_rise) return wanted;
  uav::Setpoint idle;
  idle.mask = uav::kRotorSpeeds;
  idle.in_heading = false;
  idle.rotor_speeds_rad_s.assign(
      vehicle.limits.rotors,
      vehicle.is_armed ? kIdleRotors * vehicle.limits.max_rotor_speed_rad_s : 0.0);
  return idle;
}

}  // namespace tether::autopilot
