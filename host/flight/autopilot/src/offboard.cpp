#include "offboard.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tether::autopilot {
namespace {

using uav::Vec3;

constexpr Duration kLongestGap = std::chrono::milliseconds(500);
constexpr Duration kProvenStream = std::chrono::seconds(1);

// MAV_FRAME.
constexpr int kLocalNed = 1, kBodyNed = 8;
constexpr int kGlobalInt = 5, kGlobalRelativeInt = 6, kGlobal = 0, kGlobalRelative = 3;

// Bits of type_mask: what is ignored.
constexpr std::array<unsigned, 3> kNoPosition = {1, 2, 4}, kNoVelocity = {8, 16, 32},
                                  kNoAcceleration = {64, 128, 256};
constexpr unsigned kIsForce = 512, kNoYaw = 1024, kNoYawRate = 2048;
constexpr unsigned kNoRollRate = 1, kNoPitchRate = 2, kNoTurnRate = 4, kNoThrust = 64,
                   kNoAttitude = 128;

// Gain of an axis whose position is held while others have velocities [1/s].
constexpr double kPositionGain_1_s = 1.0, kMostThere_m_s = 20.0;

bool are_all(const std::array<std::optional<double>, 3>& axes) {
  return axes[0] && axes[1] && axes[2];
}
bool is_any(const std::array<std::optional<double>, 3>& axes) {
  return axes[0] || axes[1] || axes[2];
}
std::array<double, 3> parts(const Vec3& v) {
  return {v.x, v.y, v.z};
}

}  // namespace

bool Offboard::takes(const mavlink::Message& message) {
  return uav::is_setpoint(message.name());
}

std::string Offboard::on_message(const mavlink::Message& message, const Vehicle& vehicle) {
  std::string wrong =
      message.is("SET_ATTITUDE_TARGET")
          ? read_attitude(message, vehicle)
          : read_target(message, vehicle, message.is("SET_POSITION_TARGET_GLOBAL_INT"));
  if (wrong.empty()) note(vehicle.now);
  return wrong;
}

void Offboard::note(SimTime now) {
  if (!last_at_ || now - *last_at_ > kLongestGap) stream_since_ = now;
  last_at_ = now;
}

bool Offboard::is_streaming(SimTime now) const {
  return last_at_ && now - *last_at_ <= kLongestGap && now - *stream_since_ >= kProvenStream;
}

bool Offboard::is_lost(SimTime now, Duration timeout) const {
  return !last_at_ || now - *last_at_ > timeout;
}

// A velocity in the body's heading is turned when it arrives, as the companion means it.
std::string Offboard::read_target(const mavlink::Message& message, const Vehicle& vehicle,
                                  bool is_global) {
  const auto frame = static_cast<int>(message.integer("coordinate_frame"));
  const auto mask = static_cast<unsigned>(message.integer("type_mask"));
  const bool is_body = !is_global && frame == kBodyNed;
  const bool is_relative = frame == kGlobalRelativeInt || frame == kGlobalRelative;
  if (is_global ? frame != kGlobalInt && frame != kGlobal && !is_relative
                : frame != kLocalNed && !is_body)
    return fmt::format("set-point ignored: frame {}", frame);
  if ((mask & kIsForce) != 0) return "set-point ignored: forces are not supported";

  std::array<double, 3> p{}, v{}, a{};
  constexpr const char* kAxisNames[] = {"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!is_global) p[i] = message.number(kAxisNames[i]);
    v[i] = message.number(std::string("v") + kAxisNames[i]);
    a[i] = message.number(std::string("af") + kAxisNames[i]);
  }
  if (is_global) {
    const Vec3 p_W = vehicle.frame.point(
        {message.number("lat_int") * 1e-7, message.number("lon_int") * 1e-7,
         message.number("alt") +
             (is_relative ? vehicle.frame.geodetic(vehicle.home_W).altitude_m : 0.0)});
    p = parts(vehicle.frame.point_to_ned(p_W));
  }
  if (is_body) {
    const double yaw = vehicle.frame.yaw_to_ned(uav::yaw_rad(vehicle.estimate.q_WB));
    const auto turned = [&](const std::array<double, 3>& h) {
      return std::array{std::cos(yaw) * h[0] - std::sin(yaw) * h[1],
                        std::sin(yaw) * h[0] + std::cos(yaw) * h[1], h[2]};
    };
    v = turned(v);
    a = turned(a);
  }
  Target target;
  bool has_acceleration = true;
  for (std::size_t i = 0; i < 3; ++i) {
    if ((mask & kNoPosition[i]) == 0 && !is_body) target.p_m[i] = p[i];
    if ((mask & kNoVelocity[i]) == 0) target.v_m_s[i] = v[i];
    has_acceleration = has_acceleration && (mask & kNoAcceleration[i]) == 0;
  }
  if (has_acceleration) target.acceleration_m_s2 = Vec3{a[0], a[1], a[2]};
  if ((mask & kNoYaw) == 0) target.yaw_rad = message.number("yaw");
  if ((mask & kNoYawRate) == 0) target.yaw_rate_rad_s = message.number("yaw_rate");
  if (!is_any(target.p_m) && !is_any(target.v_m_s) && !target.acceleration_m_s2)
    return "set-point ignored: it has neither position, velocity nor acceleration";
  if (const std::string wrong = complaint_about(setpoint_of(target, vehicle)); !wrong.empty())
    return "set-point ignored: " + wrong;
  target_ = target;
  direct_.reset();
  return {};
}

std::string Offboard::read_attitude(const mavlink::Message& message, const Vehicle& vehicle) {
  const auto mask = static_cast<unsigned>(message.integer("type_mask"));
  if ((mask & kNoThrust) != 0) return "set-point ignored: it has no thrust";
  const double thrust = message.number("thrust");
  if (!(thrust >= 0.0 && thrust <= 1.0)) return "set-point ignored: thrust is not within 0 and 1";
  uav::Setpoint setpoint;
  setpoint.in_heading = false;
  setpoint.thrust_N = thrust * vehicle.limits.max_thrust_N;
  if ((mask & kNoAttitude) == 0) {
    setpoint.mask = uav::kAttitude | uav::kThrust;
    setpoint.q_WB = uav::normalized(
        vehicle.frame.attitude_from_ned({message.number("q", 0), message.number("q", 1),
                                         message.number("q", 2), message.number("q", 3)}));
  } else if ((mask & (kNoRollRate | kNoPitchRate | kNoTurnRate)) == 0) {
    setpoint.mask = uav::kBodyRates | uav::kThrust;
    setpoint.w_WB_B_rad_s =
        mavlink::flu_from_frd({message.number("body_roll_rate"), message.number("body_pitch_rate"),
                               message.number("body_yaw_rate")});
  } else {
    return "set-point ignored: it has neither attitude nor all body rates";
  }
  if (const std::string wrong = complaint_about(setpoint, vehicle.limits); !wrong.empty())
    return "set-point ignored: " + wrong;
  direct_ = setpoint;
  return {};
}

uav::Setpoint Offboard::setpoint(const Vehicle& vehicle) const {
  return direct_ ? *direct_ : setpoint_of(target_, vehicle);
}

// All axes with positions, with or without velocities, enter the cascade at its position loop. If
// some axes have positions, those get the velocity that leads there.
uav::Setpoint Offboard::setpoint_of(const Target& target, const Vehicle& vehicle) const {
  const LocalFrame& frame = vehicle.frame;
  uav::Setpoint setpoint;
  setpoint.in_heading = false;
  const auto vector = [](const Axes& axes) {
    return Vec3{axes[0].value_or(0.0), axes[1].value_or(0.0), axes[2].value_or(0.0)};
  };
  if (are_all(target.p_m)) {
    setpoint.mask = uav::kPosition;
    setpoint.p_WB_m = frame.point_from_ned(vector(target.p_m));
    if (is_any(target.v_m_s)) {
      setpoint.mask |= uav::kVelocity;
      setpoint.velocity_m_s = frame.from_ned(vector(target.v_m_s));
    }
  } else if (is_any(target.p_m) || is_any(target.v_m_s)) {
    Axes v = target.v_m_s;
    const auto p = parts(frame.point_to_ned(vehicle.estimate.p_WB));
    for (std::size_t i = 0; i < 3; ++i)
      if (target.p_m[i])
        v[i] = v[i].value_or(0.0) + std::clamp(kPositionGain_1_s * (*target.p_m[i] - p[i]),
                                               -kMostThere_m_s, kMostThere_m_s);
    setpoint.mask = uav::kVelocity;
    setpoint.velocity_m_s = frame.from_ned(vector(v));
  } else {
    setpoint.mask = 0;
  }
  const bool can_accelerate = !setpoint.has(uav::kPosition) || setpoint.has(uav::kVelocity);
  if (target.acceleration_m_s2 && can_accelerate) {
    setpoint.mask |= uav::kAcceleration;
    setpoint.acceleration_m_s2 = frame.from_ned(*target.acceleration_m_s2);
  }
  if (target.yaw_rad) {
    setpoint.mask |= uav::kYaw;
    setpoint.yaw_rad = frame.yaw_from_ned(*target.yaw_rad);
  } else if (target.yaw_rate_rad_s) {
    setpoint.mask |= uav::kYawRate;
    setpoint.yaw_rate_rad_s = -*target.yaw_rate_rad_s;
  }
  return setpoint;
}

}  // namespace tether::autopilot
