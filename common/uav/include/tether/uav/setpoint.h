#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/time.h>
#include <tether/uav/math.h>

namespace tether::uav {

/// A joint that turns a part of a UAV with its sensors, as those of a gimbal do. The joints of a
/// UAV are a chain from the body outwards.
struct Joint {
  std::string name;  ///< unique within the UAV
  Vec3 p_BJ;         ///< a point of its axis, in B while all joints are at 0
  Vec3 axis_B;       ///< the axis, of unit length, likewise; right-handed
  double min_rad = 0.0;
  double max_rad = 0.0;
  double max_rate_rad_s = 0.0;  ///< with which it turns to the angle that was commanded last
  friend bool operator==(const Joint&, const Joint&) = default;
};
inline constexpr std::size_t kMaxJoints = 4;

/// The sensor of all joints of a UAV.
struct JointStateProperties {};
struct JointStateSample {
  SimTime sampled_at;
  std::uint64_t index = 0;           ///< number of this measurement of the sensor
  std::vector<double> angles_rad{};  ///< of all joints, from the body outwards
};

/// Its angle before the first command: 0, or the limit that is nearest to 0.
double start_rad(const Joint& joint);
/// Its angle after `seconds` on the way to `target_rad`.
double turned_rad(const Joint& joint, double angle_rad, double target_rad, double seconds);

/// What `X_B0` becomes, a pose in B while all joints are at 0, if the first joints have these
/// angles and it is behind them. @pre no more angles than joints
Pose turned(std::span<const Joint> joints, std::span<const double> angles_rad, const Pose& X_B0);

// What a UAV is commanded to do: one message with a mask, as flight controllers take it. The
// combinations follow MAVLink's SET_POSITION_TARGET_LOCAL_NED and SET_ATTITUDE_TARGET; the frames
// are Tether's (W: ENU, B: FLU).

/// Whether MAVLink's message of this name is a set-point.
constexpr bool is_setpoint(std::string_view message) {
  return message.starts_with("SET_POSITION_TARGET_") || message == "SET_ATTITUDE_TARGET";
}

/// A velocity and a yaw rate, held until the next command. Linear velocity is in the heading frame
/// H: x ahead along the heading, y left, z up, for any roll and pitch of the UAV.
struct VelocityCommand {
  Vec3 velocity_H_m_s;
  double yaw_rate_rad_s = 0.0;  ///< counter-clockwise seen from above
  friend bool operator==(const VelocityCommand&, const VelocityCommand&) = default;
};

/// The fields of a set-point that are given: a mask is a sum of these.
enum SetpointField : std::uint16_t {
  kPosition = 1,
  kVelocity = 2,
  kAcceleration = 4,
  kYaw = 8,
  kYawRate = 16,
  kAttitude = 32,
  kBodyRates = 64,
  kThrust = 128,
  kRotorSpeeds = 256,
  kJoints = 512,
};

/// Where a set-point enters the controller's cascade.
enum class SetpointLevel { kPosition, kVelocity, kAcceleration, kAttitude, kBodyRates, kRotors };

/// A set-point, held until the next one. By default: stand still. The mask is one of
/// - position; with velocity, or with velocity and acceleration, fed forward
/// - velocity; with acceleration, fed forward
/// - acceleration
/// - attitude and thrust
/// - body rates and thrust
/// - rotor speeds
///
/// The first three can have a yaw or a yaw rate, too; without, the UAV keeps its yaw. Each can have
/// joints, which keep their angles without; joints alone change nothing of the flight. Fields that
/// are not in the mask are ignored.
struct Setpoint {
  std::uint16_t mask = kVelocity | kYawRate;
  /// Velocity and acceleration are in the heading frame H; else in W. Not with a position.
  bool in_heading = true;
  Vec3 p_WB_m{};
  Vec3 velocity_m_s{};
  Vec3 acceleration_m_s2{};  ///< of the motion: 0 when hovering
  double yaw_rad = 0.0;      ///< counter-clockwise from east
  double yaw_rate_rad_s = 0.0;
  Quat q_WB{};
  Vec3 w_WB_B_rad_s{};
  double thrust_N = 0.0;  ///< of all rotors together, along the body's z
  std::vector<double> rotor_speeds_rad_s{};
  std::vector<double> joints_rad{};  ///< of all joints, from the body outwards

  constexpr bool has(SetpointField field) const { return (mask & field) != 0; }
  /// Whether it has more than joints.
  constexpr bool flies() const { return (mask & ~kJoints) != 0; }
  friend bool operator==(const Setpoint&, const Setpoint&) = default;
};

/// A set-point of a trajectory.
struct TimedSetpoint {
  Duration after{0};  ///< from the command's arrival at the flight controller
  Setpoint setpoint;
  friend bool operator==(const TimedSetpoint&, const TimedSetpoint&) = default;
};
inline constexpr std::size_t kMaxTrajectorySetpoints = 1024;
inline constexpr Duration kLongestTrajectory = std::chrono::hours(1);

/// Topic of an annotation with which the library's programs end if it refused commands of theirs,
/// which were invalid; if other threads computed during calls, which a clock of CPU time does not
/// charge, or between them, which it does; or if they read their clock so often that they probably
/// wait in a loop: {"refused_commands": 20, "uncharged_ms": 0, "others_ms": 0, "clock_read_hz": 0},
/// the times in execution time.
inline constexpr const char* kClientReport = "client_report";
/// No program reads its clock so often for anything but to wait.
inline constexpr double kPollingClock_hz = 20e3;

/// What a flight controller does when no command has arrived for too long.
enum class LossAction {
  kKeep,   ///< goes on with the last set-point
  kHover,  ///< stays where it is at that instant
  kBrake,  ///< stops, wherever that is
  kLand,   ///< descends where it is, at 0.4 m/s
};
std::string_view name(LossAction action);  ///< "keep", "hover", "brake" or "land"
struct SetpointLoss {
  Duration timeout{0};  ///< > 0; from the last set-point's effect, without rounding to a step
  LossAction action = LossAction::kKeep;
  friend bool operator==(const SetpointLoss&, const SetpointLoss&) = default;
};
/// What is followed then. `last`: the last set-point; `p_WB_m`: where the UAV is.
Setpoint setpoint_on_loss(LossAction action, const Setpoint& last, const Vec3& p_WB_m);

/// The most that a UAV can be commanded.
struct FlightLimits {
  std::uint32_t rotors = 0;  ///< 0: it only takes velocities in the heading frame
  double max_rotor_speed_rad_s = 0.0;
  double max_thrust_N = 0.0;  ///< of all rotors together
  std::vector<Joint> joints{};
  friend bool operator==(const FlightLimits&, const FlightLimits&) = default;
};

Setpoint to_setpoint(const VelocityCommand& command);
/// Of a set-point that is a velocity in the heading frame, with or without a yaw rate; else none.
std::optional<VelocityCommand> heading_velocity(const Setpoint& setpoint);
/// Without its joints.
Setpoint flight_of(Setpoint setpoint);
/// None: the mask is no set-point, or has joints only.
std::optional<SetpointLevel> level_of(std::uint16_t mask);
/// The same set-point: fields that are not in the mask have their defaults.
Setpoint without_ignored(const Setpoint& setpoint);

/// Each field: `f(bit, value, largest magnitude of a part, name)`.
void each_field(auto& setpoint, auto&& f) {
  f(kPosition, setpoint.p_WB_m, 1e5, "position");
  f(kVelocity, setpoint.velocity_m_s, 100.0, "velocity");
  f(kAcceleration, setpoint.acceleration_m_s2, 1000.0, "acceleration");
  f(kYaw, setpoint.yaw_rad, 100.0, "yaw");
  f(kYawRate, setpoint.yaw_rate_rad_s, 100.0, "yaw rate");
  f(kAttitude, setpoint.q_WB, 2.0, "attitude");
  f(kBodyRates, setpoint.w_WB_B_rad_s, 100.0, "body rates");
  f(kThrust, setpoint.thrust_N, 1e6, "thrust");
  f(kRotorSpeeds, setpoint.rotor_speeds_rad_s, 1e5, "rotor speeds");
  f(kJoints, setpoint.joints_rad, 100.0, "joint angles");
}

/// What is wrong with a set-point for any UAV: "the mask 3 …"; empty: nothing. Numbers must be
/// finite and within what no multirotor exceeds, an attitude must be of unit length to 1e-6, and
/// thrust and rotor speeds not negative.
std::string complaint_about(const Setpoint& setpoint);
/// The same for a UAV with these limits.
std::string complaint_about(const Setpoint& setpoint, const FlightLimits& limits);
/// The same for each of a trajectory, with its number. There must be 1 to 1024, at times that begin
/// with 0, increase, and are at most an hour; joints alone are a command of their own. None: the
/// limits are not known.
std::string complaint_about(std::span<const TimedSetpoint> trajectory,
                            const std::optional<FlightLimits>& limits = std::nullopt);

}  // namespace tether::uav
