#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
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

}  // namespace tether::uav
