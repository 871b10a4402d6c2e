#include "telemetry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <tether/base/units.h>

namespace tether::autopilot {
namespace {

using mavlink::Message;
using uav::Vec3;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kGravity_m_s2 = 9.80665;

std::int64_t ms_of(const TelemetrySource& s) {
  return to_ns(s.vehicle.now) / 1'000'000;
}
std::int64_t us_of(const TelemetrySource& s) {
  return to_ns(s.vehicle.now) / 1000;
}

void set_xyz(Message& m, const char* x, const char* y, const char* z, const Vec3& v,
             double unit = 1.0) {
  m.set(x, v.x * unit).set(y, v.y * unit).set(z, v.z * unit);
}

Vec3 position_ned(const TelemetrySource& s) {
  return s.vehicle.frame.point_to_ned(s.vehicle.estimate.p_WB);
}
Vec3 velocity_ned(const TelemetrySource& s) {
  return s.vehicle.frame.to_ned(s.vehicle.estimate.v_WB);
}
Vec3 rates_frd(const TelemetrySource& s) {
  return mavlink::frd_from_flu(s.vehicle.estimate.w_WB_B);
}
uav::Quat attitude_ned(const TelemetrySource& s) {
  return s.vehicle.frame.attitude_to_ned(s.vehicle.estimate.q_WB);
}
struct Euler {
  double roll, pitch, yaw;
};
Euler euler_of(const uav::Quat& q) {
  return {std::atan2(2.0 * (q.w * q.x + q.y * q.z), 1.0 - 2.0 * (q.x * q.x + q.y * q.y)),
          std::asin(std::clamp(2.0 * (q.w * q.y - q.z * q.x), -1.0, 1.0)),
          std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))};
}
double heading_deg(const TelemetrySource& s) {
  const double deg = deg_from_rad(euler_of(attitude_ned(s)).yaw);
  return deg < 0.0 ? deg + 360.0 : deg;
}
sim::Geodetic place_of(const TelemetrySource& s) {
  return s.vehicle.frame.geodetic(s.vehicle.estimate.p_WB);
}
double home_altitude_m(const TelemetrySource& s) {
  return s.vehicle.frame.geodetic(s.vehicle.home_W).altitude_m;
}

void heartbeat(const TelemetrySource& s, Message& m) {
  constexpr int kQuadrotor = 2, kPx4 = 12;
  constexpr int kArmed = 128, kStabilised = 16, kGuided = 8, kAuto = 4, kCustom = 1;
  constexpr int kStandby = 3, kActive = 4, kCritical = 5;
  const Mode mode = s.vehicle.mode;
  const int automatic = mode == Mode::kPosition   ? kStabilised | kGuided
                        : mode == Mode::kOffboard ? kStabilised | kGuided
                                                  : kStabilised | kGuided | kAuto;
  m.set("type", kQuadrotor)
      .set("autopilot", kPx4)
      .set("base_mode", kCustom | automatic | (s.vehicle.is_armed ? kArmed : 0))
      .set("custom_mode", custom_mode(mode))
      .set("system_status", s.vehicle.is_failsafe ? kCritical
                            : s.vehicle.is_armed  ? kActive
                                                  : kStandby)
      .set("mavlink_version", 3);
}

void sys_status(const TelemetrySource& s, Message& m) {
  // Gyroscope, accelerometer, magnetometer, barometer, GPS, attitude, yaw, position, motors.
  constexpr int kSensors = 1 | 2 | 4 | 8 | 32 | 2048 | 4096 | 8192 | 16384 | 32768;
  for (const char* field : {"onboard_control_sensors_present", "onboard_control_sensors_enabled",
                            "onboard_control_sensors_health"})
    m.set(field, kSensors);
  const auto& battery = s.vehicle.battery;
  m.set("voltage_battery", battery ? battery->voltage_V * 1e3 : 65535.0)
      .set("current_battery", battery ? battery->current_A * 100.0 : -1.0)
      .set("battery_remaining", battery ? std::round(battery->charge * 100.0) : -1.0);
}

void system_time(const TelemetrySource& s, Message& m) {
  m.set("time_unix_usec", 0).set("time_boot_ms", ms_of(s));
}

void attitude(const TelemetrySource& s, Message& m) {
  const Euler euler = euler_of(attitude_ned(s));
  m.set("time_boot_ms", ms_of(s))
      .set("roll", euler.roll)
      .set("pitch", euler.pitch)
      .set("yaw", euler.yaw);
  set_xyz(m, "rollspeed", "pitchspeed", "yawspeed", rates_frd(s));
}

void attitude_quaternion(const TelemetrySource& s, Message& m) {
  const uav::Quat q = attitude_ned(s);
  m.set("time_boot_ms", ms_of(s)).set("q1", q.w).set("q2", q.x).set("q3", q.y).set("q4", q.z);
  set_xyz(m, "rollspeed", "pitchspeed", "yawspeed", rates_frd(s));
}

void local_position(const TelemetrySource& s, Message& m) {
  m.set("time_boot_ms", ms_of(s));
  set_xyz(m, "x", "y", "z", position_ned(s));
  set_xyz(m, "vx", "vy", "vz", velocity_ned(s));
}

void global_position(const TelemetrySource& s, Message& m) {
  const sim::Geodetic place = place_of(s);
  m.set("time_boot_ms", ms_of(s))
      .set("lat", place.latitude_deg * 1e7)
      .set("lon", place.longitude_deg * 1e7)
      .set("alt", place.altitude_m * 1e3)
      .set("relative_alt", (place.altitude_m - home_altitude_m(s)) * 1e3)
      .set("hdg", heading_deg(s) * 100.0);
  set_xyz(m, "vx", "vy", "vz", velocity_ned(s), 100.0);
}

// The vehicle's receiver, if it has one; else the estimate.
void gps_raw(const TelemetrySource& s, Message& m) {
  constexpr int kFix3d = 3, kNoFix = 1;
  const auto measured =
      s.sensed.measure ? s.sensed.measure(uav::SensorKind::kNavSat) : std::nullopt;
  sim::Geodetic place = place_of(s);
  Vec3 v_ENU = mavlink::enu_from_ned(velocity_ned(s));
  double horizontal_m = 0.5, vertical_m = 0.8, speed_m_s = 0.1;
  bool has_fix = true;
  if (measured) {
    const auto& fix = std::get<uav::NavSatSample>(*measured);
    has_fix = fix.has_fix;
    place = {fix.latitude_deg, fix.longitude_deg, fix.altitude_m};
    v_ENU = fix.velocity_ENU_m_s;
    horizontal_m = fix.horizontal_accuracy_m;
    vertical_m = fix.vertical_accuracy_m;
    speed_m_s = fix.speed_accuracy_m_s;
  }
  m.set("time_usec", us_of(s)).set("fix_type", has_fix ? kFix3d : kNoFix);
  m.set("eph", 65535).set("epv", 65535).set("vel", 65535).set("cog", 65535);
  m.set("satellites_visible", has_fix ? 10 : 0);
  if (!has_fix) return;
  double course_deg = deg_from_rad(std::atan2(v_ENU.x, v_ENU.y));
  if (course_deg < 0.0) course_deg += 360.0;
  m.set("lat", place.latitude_deg * 1e7)
      .set("lon", place.longitude_deg * 1e7)
      .set("alt", place.altitude_m * 1e3)
      .set("alt_ellipsoid", place.altitude_m * 1e3)
      .set("vel", std::hypot(v_ENU.x, v_ENU.y) * 100.0)
      .set("cog", course_deg * 100.0)
      .set("h_acc", horizontal_m * 1e3)
      .set("v_acc", vertical_m * 1e3)
      .set("vel_acc", speed_m_s * 1e3);
}

void altitude(const TelemetrySource& s, Message& m) {
  const double above_sea = place_of(s).altitude_m;
  m.set("time_usec", us_of(s))
      .set("altitude_monotonic", above_sea)
      .set("altitude_amsl", above_sea)
      .set("altitude_local", -position_ned(s).z)
      .set("altitude_relative", above_sea - home_altitude_m(s))
      .set("altitude_terrain", kNan)
      .set("bottom_clearance", kNan);
}

void vfr_hud(const TelemetrySource& s, Message& m) {
  const Vec3 v = velocity_ned(s);
  m.set("airspeed", std::hypot(v.x, v.y))
      .set("groundspeed", std::hypot(v.x, v.y))
      .set("heading", heading_deg(s))
      .set("throttle", s.vehicle.is_armed && !s.vehicle.is_landed ? 50 : 0)
      .set("alt", place_of(s).altitude_m)
      .set("climb", -v.z);
}

void odometry(const TelemetrySource& s, Message& m) {
  constexpr int kNed = 1, kFrd = 12;
  const uav::Quat q = attitude_ned(s);
  m.set("time_usec", us_of(s)).set("frame_id", kNed).set("child_frame_id", kFrd);
  set_xyz(m, "x", "y", "z", position_ned(s));
  m.set("q", q.w, 0).set("q", q.x, 1).set("q", q.y, 2).set("q", q.z, 3);
  set_xyz(m, "vx", "vy", "vz",
          mavlink::frd_from_flu(rotate(inverse(s.vehicle.estimate.q_WB), s.vehicle.estimate.v_WB)));
  set_xyz(m, "rollspeed", "pitchspeed", "yawspeed", rates_frd(s));
  for (const char* field : {"pose_covariance", "velocity_covariance"}) m.set(field, kNan);
  if (const auto& from = s.vehicle.odometry) {
    const auto square = [](double x) { return x * x; };
    // Upper right triangles, row by row, of x y z roll pitch yaw: the diagonal is at 0, 6, 11, …
    const Vec3 p = from->position_stddev_m, a = from->attitude_stddev_rad,
               v = from->velocity_stddev_m_s;
    for (std::size_t i = 0; i < 21; ++i)
      m.set("pose_covariance", 0.0, i).set("velocity_covariance", 0.0, i);
    m.set("pose_covariance", square(p.y), 0)
        .set("pose_covariance", square(p.x), 6)
        .set("pose_covariance", square(p.z), 11)
        .set("pose_covariance", square(a.x), 15)
        .set("pose_covariance", square(a.y), 18)
        .set("pose_covariance", square(a.z), 20);
    m.set("velocity_covariance", square(v.x), 0)
        .set("velocity_covariance", square(v.y), 6)
        .set("velocity_covariance", square(v.z), 11);
  }
  m.set("estimator_type", 0).set("quality", 0);
}

// The vehicle's own sensors, if it has them.
void highres_imu(const TelemetrySource& s, Message& m) {
  m.set("time_usec", us_of(s));
  int updated = 0;
  const auto measure = [&](uav::SensorKind kind) {
    return s.sensed.measure ? s.sensed.measure(kind) : std::nullopt;
  };
  if (const auto sample = measure(uav::SensorKind::kImu)) {
    const auto& imu = std::get<uav::ImuSample>(*sample);
    set_xyz(m, "xacc", "yacc", "zacc", mavlink::frd_from_flu(imu.specific_force_m_s2));
    set_xyz(m, "xgyro", "ygyro", "zgyro", mavlink::frd_from_flu(imu.angular_velocity_rad_s));
    updated |= 0x3F;
  }
  if (const auto sample = measure(uav::SensorKind::kMagnetometer)) {
    constexpr double kGaussOfTesla = 1e4;
    set_xyz(m, "xmag", "ymag", "zmag",
            mavlink::frd_from_flu(std::get<uav::MagnetometerSample>(*sample).field_T),
            kGaussOfTesla);
    updated |= 0x1C0;
  }
  if (const auto sample = measure(uav::SensorKind::kBarometer)) {
    const auto& barometer = std::get<uav::BarometerSample>(*sample);
    m.set("abs_pressure", barometer.pressure_Pa / 100.0).set("pressure_alt", barometer.altitude_m);
    updated |= 0x200 | 0x800;
  }
  m.set("fields_updated", updated);
}

void position_target(const TelemetrySource& s, Message& m) {
  const uav::Setpoint& sp = s.setpoint;
  const Vec3 p = s.vehicle.frame.point_to_ned(sp.p_WB_m);
  const unsigned mask = (sp.has(uav::kPosition) ? 0U : 7U) | (sp.has(uav::kVelocity) ? 0U : 56U) |
                        (sp.has(uav::kAcceleration) ? 0U : 448U) |
                        (sp.has(uav::kYaw) ? 0U : 1024U) | (sp.has(uav::kYawRate) ? 0U : 2048U);
  m.set("time_boot_ms", ms_of(s)).set("coordinate_frame", 1).set("type_mask", mask);
  if (sp.has(uav::kPosition)) set_xyz(m, "x", "y", "z", p);
  if (sp.has(uav::kVelocity)) set_xyz(m, "vx", "vy", "vz", s.vehicle.frame.to_ned(sp.velocity_m_s));
  if (sp.has(uav::kAcceleration))
    set_xyz(m, "afx", "afy", "afz", s.vehicle.frame.to_ned(sp.acceleration_m_s2));
  if (sp.has(uav::kYaw)) m.set("yaw", s.vehicle.frame.yaw_to_ned(sp.yaw_rad));
  if (sp.has(uav::kYawRate)) m.set("yaw_rate", -sp.yaw_rate_rad_s);
}

void attitude_target(const TelemetrySource& s, Message& m) {
  const uav::Setpoint& sp = s.setpoint;
  m.set("time_boot_ms", ms_of(s))
      .set("type_mask", (sp.has(uav::kBodyRates) ? 0 : 7) | (sp.has(uav::kAttitude) ? 0 : 128) |
                            (sp.has(uav::kThrust) ? 0 : 64));
  if (sp.has(uav::kAttitude)) {
    const uav::Quat q = s.vehicle.frame.attitude_to_ned(sp.q_WB);
    m.set("q", q.w, 0).set("q", q.x, 1).set("q", q.y, 2).set("q", q.z, 3);
  }
  if (sp.has(uav::kBodyRates))
    set_xyz(m, "body_roll_rate", "body_pitch_rate", "body_yaw_rate",
            mavlink::frd_from_flu(sp.w_WB_B_rad_s));
  if (sp.has(uav::kThrust)) m.set("thrust", sp.thrust_N / s.vehicle.limits.max_thrust_N);
}

void battery_status(const TelemetrySource& s, Message& m) {
  constexpr int kLithiumPolymer = 1;
  m.set("battery_function", 0).set("type", kLithiumPolymer).set("temperature", 32767);
  for (std::size_t i = 0; i < 10; ++i) m.set("voltages", 65535, i);
  m.set("current_consumed", -1).set("energy_consumed", -1).set("current_battery", -1);
  m.set("battery_remaining", -1);
  if (const auto& battery = s.vehicle.battery)
    m.set("voltages", battery->voltage_V * 1e3, 0)
        .set("current_battery", battery->current_A * 100.0)
        .set("battery_remaining", std::round(battery->charge * 100.0));
}

void extended_state(const TelemetrySource& s, Message& m) {
  constexpr int kOnGround = 1, kInAir = 2, kTakingOff = 3, kLanding = 4;
  const int state = s.vehicle.is_landed                ? kOnGround
                    : s.vehicle.mode == Mode::kTakeoff ? kTakingOff
                    : s.vehicle.mode == Mode::kLand    ? kLanding
                                                       : kInAir;
  m.set("vtol_state", 0).set("landed_state", state);
}

void home_position(const TelemetrySource& s, Message& m) {
  const sim::Geodetic home = s.vehicle.frame.geodetic(s.vehicle.home_W);
  m.set("latitude", home.latitude_deg * 1e7)
      .set("longitude", home.longitude_deg * 1e7)
      .set("altitude", home.altitude_m * 1e3);
  set_xyz(m, "x", "y", "z", s.vehicle.frame.point_to_ned(s.vehicle.home_W));
  m.set("q", 1.0, 0);
  m.set("approach_x", kNan).set("approach_y", kNan).set("approach_z", kNan);
  m.set("time_usec", us_of(s));
}

void estimator_status(const TelemetrySource& s, Message& m) {
  // Attitude, velocities, horizontal position (relative, absolute), vertical position.
  m.set("time_usec", us_of(s)).set("flags", 1 | 2 | 4 | 8 | 16 | 32);
  if (const auto& from = s.vehicle.odometry)
    m.set("pos_horiz_accuracy", from->position_stddev_m.x)
        .set("pos_vert_accuracy", from->position_stddev_m.z);
}

void global_origin(const TelemetrySource& s, Message& m) {
  const sim::Geodetic origin = s.vehicle.frame.geodetic(s.vehicle.frame.origin());
  m.set("latitude", origin.latitude_deg * 1e7)
      .set("longitude", origin.longitude_deg * 1e7)
      .set("altitude", origin.altitude_m * 1e3)
      .set("time_usec", us_of(s));
}

void autopilot_version(const TelemetrySource&, Message& m) {
  // MISSION_INT, COMMAND_INT, parameters by bytes, set-points (attitude, local and global
  // position), MAVLink 2.
  m.set("capabilities", 4 | 8 | 16 | 64 | 128 | 256 | 8192);
  m.set("flight_sw_version", 0x010E00FF);  // 1.14.0, as PX4 writes it
}

void mission_current(const TelemetrySource& s, Message& m) {
  m.set("seq", s.missions.shown()).set("total", s.missions.items().size());
}

struct StreamRow {
  std::string_view name;
  double rate_hz;  // 0: only on request
  void (*fill)(const TelemetrySource&, Message&);
};
constexpr StreamRow kStreams[] = {
    {"HEARTBEAT", 1.0, heartbeat},
    {"SYS_STATUS", 1.0, sys_status},
    {"SYSTEM_TIME", 1.0, system_time},
    {"ATTITUDE", 100.0, attitude},
    {"ATTITUDE_QUATERNION", 50.0, attitude_quaternion},
    {"LOCAL_POSITION_NED", 30.0, local_position},
    {"GLOBAL_POSITION_INT", 50.0, global_position},
    {"GPS_RAW_INT", 5.0, gps_raw},
    {"ALTITUDE", 10.0, altitude},
    {"VFR_HUD", 10.0, vfr_hud},
    {"ODOMETRY", 30.0, odometry},
    {"HIGHRES_IMU", 50.0, highres_imu},
    {"POSITION_TARGET_LOCAL_NED", 10.0, position_target},
    {"ATTITUDE_TARGET", 10.0, attitude_target},
    {"BATTERY_STATUS", 0.5, battery_status},
    {"EXTENDED_SYS_STATE", 5.0, extended_state},
    {"HOME_POSITION", 0.5, home_position},
    {"ESTIMATOR_STATUS", 1.0, estimator_status},
    {"GPS_GLOBAL_ORIGIN", 0.0, global_origin},
    {"AUTOPILOT_VERSION", 0.0, autopilot_version},
    {"MISSION_CURRENT", 1.0, mission_current},
};

constexpr double kBitsOfByte = 10.0, kMostSlowed = 20.0;
constexpr std::size_t kFrameBytes = 12;  // besides the payload, not signed
bool is_fixed(const mavlink::MessageType& type) {
  return type.name == "HEARTBEAT";
}

const StreamRow* find_stream(std::string_view name) {
  const auto* found = std::ranges::find(kStreams, name, &StreamRow::name);
  return found == std::end(kStreams) ? nullptr : found;
}
std::optional<Duration> interval_of(const StreamRow& row) {
  if (row.rate_hz == 0.0) return std::nullopt;
  return duration_from_seconds(1.0 / row.rate_hz);
}

}  // namespace

std::vector<StreamRate> stream_rates() {
  std::vector<StreamRate> rates;
  for (const StreamRow& row : kStreams) rates.push_back({row.name, row.rate_hz});
  return rates;
}

Telemetry::Telemetry(double link_baud) : most_B_s_(link_baud / kBitsOfByte / 2.0) {
  for (const StreamRow& row : kStreams)
    streams_.push_back({.type = mavlink::find_type(row.name), .interval = interval_of(row)});
  fit_line();
}

void Telemetry::fit_line() {
  double fixed_B_s = 0.0, wanted_B_s = 0.0;
  for (const Stream& stream : streams_) {
    if (!stream.interval) continue;
    const auto bytes = static_cast<double>(kFrameBytes + stream.type->length);
    (is_fixed(*stream.type) ? fixed_B_s : wanted_B_s) +=
        bytes / std::chrono::duration<double>(*stream.interval).count();
  }
  const double slow_by =
      most_B_s_ > 0.0
          ? std::clamp(wanted_B_s / std::max(most_B_s_ - fixed_B_s, 1.0), 1.0, kMostSlowed)
          : 1.0;
  for (Stream& stream : streams_) {
    if (!stream.interval) continue;
    stream.slowed = *stream.interval;
    if (slow_by > 1.0 && !is_fixed(*stream.type))
      stream.slowed =
          duration_from_seconds(std::chrono::duration<double>(*stream.interval).count() * slow_by);
  }
}

void Telemetry::step(const TelemetrySource& source, Outbox& outbox) {
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    Stream& stream = streams_[i];
    const bool is_due = stream.interval && source.vehicle.now >= stream.next;
    if (is_due) {
      const Duration now = source.vehicle.now.time_since_epoch();
      stream.next = SimTime((now / stream.slowed + 1) * stream.slowed);
    }
    if (!is_due && !stream.is_requested) continue;
    stream.is_requested = false;
    Message message(*stream.type);
    kStreams[i].fill(source, message);
    outbox.send(message);
  }
}

bool Telemetry::request(std::string_view name) {
  const StreamRow* row = find_stream(name);
  if (row != nullptr) streams_[static_cast<std::size_t>(row - kStreams)].is_requested = true;
  return row != nullptr;
}

bool Telemetry::set_interval(std::string_view name, double interval_us) {
  constexpr double kLeast_us = 1e3, kMost_us = 3.6e9;
  const StreamRow* row = find_stream(name);
  if (row == nullptr || std::isnan(interval_us)) return false;
  Stream& stream = streams_[static_cast<std::size_t>(row - kStreams)];
  stream.interval = interval_us < 0.0 ? std::nullopt
                    : interval_us == 0.0
                        ? interval_of(*row)
                        : std::optional(duration_from_seconds(
                              std::clamp(interval_us, kLeast_us, kMost_us) * 1e-6));
  stream.next = SimTime{};
  fit_line();
  return true;
}

bool Telemetry::tell_interval(const mavlink::MessageType& type, Outbox& outbox) const {
  const StreamRow* row = find_stream(type.name);
  if (row == nullptr) return false;
  const auto& interval = streams_[static_cast<std::size_t>(row - kStreams)].interval;
  outbox.send(
      Message("MESSAGE_INTERVAL")
          .set("message_id", type.id)
          .set("interval_us", interval ? static_cast<double>(to_ns(*interval)) / 1e3 : -1.0));
  return true;
}

}  // namespace tether::autopilot
