#include <cmath>
#include <utility>

#include <tether/uav/setpoint.h>

namespace tether::uav {
namespace {

constexpr std::uint16_t kAnyYaw = kYaw | kYawRate;

struct Combination {
  std::uint16_t mask;  // without yaw and yaw rate
  SetpointLevel level;
};
constexpr Combination kCombinations[] = {
    {kPosition, SetpointLevel::kPosition},
    {kPosition | kVelocity, SetpointLevel::kPosition},
    {kPosition | kVelocity | kAcceleration, SetpointLevel::kPosition},
    {kVelocity, SetpointLevel::kVelocity},
    {kVelocity | kAcceleration, SetpointLevel::kVelocity},
    {kAcceleration, SetpointLevel::kAcceleration},
    {kAttitude | kThrust, SetpointLevel::kAttitude},
    {kBodyRates | kThrust, SetpointLevel::kBodyRates},
    {kRotorSpeeds, SetpointLevel::kRotors},
};

// The largest magnitude of a part; not a number if one is not.
double largest(double value) {
  return std::abs(value);
}
double larger(double a, double b) {
  return std::isnan(a) || a >= b ? a : b;
}
double largest(const Vec3& v) {
  return larger(larger(largest(v.x), largest(v.y)), largest(v.z));
}
double largest(const Quat& q) {
  return larger(largest(q.w), largest(Vec3{q.x, q.y, q.z}));
}
double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = larger(largest(value), most);
  return most;
}

bool is_unit(const Quat& q) {
  return std::abs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1.0) < 1e-6;
}

std::string number(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string complaint_about_mask(const Setpoint& setpoint) {
  std::string given;
  int known = 0;
  each_field(setpoint, [&](SetpointField field, const auto&, double, const char* name) {
    known |= field;
    if (setpoint.has(field)) given.append(given.empty() ? "" : " + ").append(name);
  });
  const bool has_unknown = (setpoint.mask & ~known) != 0;
  if (has_unknown) given.append(given.empty() ? "" : " + ").append("unknown fields");
  const bool turns_twice = (setpoint.mask & kAnyYaw) == kAnyYaw;
  return "the mask " + std::to_string(setpoint.mask) +
         " is no set-point: " + (given.empty() ? "nothing" : given) +
         (turns_twice ? ". Give a yaw or a yaw rate, not both"
                      : ". Give a position, a velocity or an acceleration, each perhaps with a yaw "
                        "or a yaw rate, an attitude with a thrust, body rates with a thrust, rotor "
                        "speeds, or joints");
}

}  // namespace

Setpoint to_setpoint(const VelocityCommand& command) {
  return {.velocity_m_s = command.velocity_H_m_s, .yaw_rate_rad_s = command.yaw_rate_rad_s};
}

std::optional<VelocityCommand> heading_velocity(const Setpoint& setpoint) {
  if (!setpoint.in_heading || (setpoint.mask | kYawRate) != (kVelocity | kYawRate))
    return std::nullopt;
  return VelocityCommand{setpoint.velocity_m_s,
                         setpoint.has(kYawRate) ? setpoint.yaw_rate_rad_s : 0.0};
}

Setpoint flight_of(Setpoint setpoint) {
  setpoint.mask &= static_cast<std::uint16_t>(~kJoints);
  setpoint.joints_rad.clear();
  return setpoint;
}

std::optional<SetpointLevel> level_of(std::uint16_t mask) {
  mask &= static_cast<std::uint16_t>(~kJoints);
  for (const auto& [fields, level] : kCombinations) {
    const bool may_turn = level <= SetpointLevel::kAcceleration && (mask & kAnyYaw) != kAnyYaw;
    if (mask == fields || (may_turn && (mask & ~kAnyYaw) == fields)) return level;
  }
  return std::nullopt;
}

Setpoint without_ignored(const Setpoint& setpoint) {
  const Setpoint defaults;
  Setpoint cleaned = setpoint;
  const auto clean = [&](SetpointField field, auto& value, double, const char*) {
    if (!setpoint.has(field)) value = {};
  };
  each_field(cleaned, clean);
  const auto level = level_of(setpoint.mask);
  if (!level || level > SetpointLevel::kAcceleration) cleaned.in_heading = defaults.in_heading;
  return cleaned;
}

std::string_view name(LossAction action) {
  constexpr std::string_view kNames[] = {"keep", "hover", "brake", "land"};
  return kNames[static_cast<std::size_t>(action)];
}

Setpoint setpoint_on_loss(LossAction action, const Setpoint& last, const Vec3& p_WB_m) {
  constexpr double kDescent_m_s = 0.4;
  switch (action) {
    case LossAction::kHover:
      return {.mask = kPosition, .in_heading = false, .p_WB_m = p_WB_m};
    case LossAction::kBrake:
      return {};
    case LossAction::kLand:
      return to_setpoint({{0.0, 0.0, -kDescent_m_s}, 0.0});
    case LossAction::kKeep:
      break;
  }
  return last;
}

std::string complaint_about(const Setpoint& setpoint) {
  const auto level = level_of(setpoint.mask);
  if (!level && setpoint.mask != kJoints) return complaint_about_mask(setpoint);
  std::string wrong;
  each_field(setpoint, [&](SetpointField field, const auto& value, double most, const char* name) {
    if (wrong.empty() && setpoint.has(field) && !(largest(value) <= most))
      wrong.append("the ")
          .append(name)
          .append(" must be finite, and at most ")
          .append(number(most));
  });
  if (!wrong.empty()) return wrong;
  if (setpoint.in_heading && level == SetpointLevel::kPosition)
    return "a position needs velocity and acceleration in the world frame";
  if (setpoint.has(kAttitude) && !is_unit(setpoint.q_WB))
    return "the attitude is not a unit quaternion";
  if (setpoint.has(kThrust) && setpoint.thrust_N < 0.0) return "the thrust is negative";
  for (const double speed : setpoint.rotor_speeds_rad_s)
    if (setpoint.has(kRotorSpeeds) && speed < 0.0) return "a rotor speed is negative";
  return {};
}

namespace {

std::string complaint_about_joints(const std::vector<double>& angles_rad,
                                   const std::vector<Joint>& joints) {
  if (joints.empty()) return "the UAV has no joints";
  if (angles_rad.size() != joints.size())
    return "there are " + std::to_string(angles_rad.size()) + " joint angles, but the UAV has " +
           std::to_string(joints.size()) + " joints";
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (angles_rad[i] < joints[i].min_rad || angles_rad[i] > joints[i].max_rad)
      return "the angle of joint '" + joints[i].name + "' is not within " +
             number(joints[i].min_rad) + ".." + number(joints[i].max_rad) + " rad";
  return {};
}

}  // namespace

std::string complaint_about(const Setpoint& setpoint, const FlightLimits& limits) {
  if (std::string wrong = complaint_about(setpoint); !wrong.empty()) return wrong;
  if (setpoint.has(kJoints)) {
    std::string wrong = complaint_about_joints(setpoint.joints_rad, limits.joints);
    if (!wrong.empty() || !setpoint.flies()) return wrong;
  }
  if (limits.rotors == 0 && !heading_velocity(flight_of(setpoint)))
    return "the simulator or vehicle only takes velocities in the heading frame";
  if (setpoint.has(kThrust) && setpoint.thrust_N > limits.max_thrust_N)
    return "the thrust is above " + number(limits.max_thrust_N) + " N, the most of the rotors";
  if (!setpoint.has(kRotorSpeeds)) return {};
  if (setpoint.rotor_speeds_rad_s.size() != limits.rotors)
    return "there are " + std::to_string(setpoint.rotor_speeds_rad_s.size()) +
           " rotor speeds, but the UAV has " + std::to_string(limits.rotors) + " rotors";
  if (largest(setpoint.rotor_speeds_rad_s) > limits.max_rotor_speed_rad_s)
    return "a rotor speed is above " + number(limits.max_rotor_speed_rad_s) +
           " rad/s, the most of the rotors";
  return {};
}

std::string complaint_about(std::span<const TimedSetpoint> trajectory,
                            const std::optional<FlightLimits>& limits) {
  const std::size_t count = trajectory.size();
  if (count == 0 || count > kMaxTrajectorySetpoints)
    return "there are no set-points, or more than " + std::to_string(kMaxTrajectorySetpoints);
  Duration earliest{0};
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [after, setpoint] = trajectory[i];
    std::string wrong;
    if (after < earliest || after > kLongestTrajectory || (i == 0 && after != Duration(0)))
      wrong = "the times must begin with 0, increase, and be at most an hour";
    else if (count > 1 && setpoint.mask == kJoints)
      wrong = "joints alone must be a command of their own";
    else
      wrong = limits ? complaint_about(setpoint, *limits) : complaint_about(setpoint);
    if (!wrong.empty())
      return count == 1 ? wrong : "set-point " + std::to_string(i + 1) + ": " + wrong;
    earliest = after + Duration(1);
  }
  return {};
}

}  // namespace tether::uav
