#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <tether/sim/bodies.h>
#include <tether/sim/world.h>
#include <tether/uav/math.h>

namespace tether::sim {

/// The motion of a UAV's body origin over the last step, for its sensors.
struct BodyMotion {
  uav::Vec3 w_WB_B;      ///< angular velocity now [rad/s]
  uav::Vec3 a_WB_W;      ///< acceleration of B's origin over the last step [m/s²]
  uav::Vec3 alpha_WB_B;  ///< angular acceleration over the last step [rad/s²]
  uav::Vec3 v_WB_W{};    ///< velocity of B's origin now [m/s]
};

/// How many steps the shutter of any camera, and the sweep of any lidar, reaches back: that many
/// past poses of each moving body are in a captured state.
/// @throws Error(kBadFile) for a shutter that is negative or longer than 1 s.
std::size_t shutter_steps(const World& world);
/// The same of one camera, with such steps. @pre a shutter of at most 1 s
std::size_t shutter_steps(const CameraModel& camera, Duration step);

/// The layout of `Snapshot::state` of every back end whose sensors are made by the sensing library:
/// position and quaternion of each of `moving_bodies` (7 numbers each), then the BodyMotion of each
/// UAV (12 numbers each) and the angles of all joints, then the positions, quaternions and angles
/// again at each of the `shutter_steps` past steps, oldest first.
///
/// Reads such states, as StateRecorder captures them. A value; safe from any thread.
class StateLayout {
 public:
  /// @throws Error(kBadFile) as `shutter_steps` does.
  explicit StateLayout(const World& world);

  std::size_t bodies() const { return bodies_; }  ///< `moving_bodies`, the UAVs first
  std::size_t uavs() const { return uavs_; }
  std::size_t past_steps() const { return past_steps_; }
  /// How many numbers a state has.
  std::size_t size() const;
  /// Where in a state the motion of UAV `uav` begins, and the first of the past poses.
  std::size_t motion_at(std::size_t uav) const;
  std::size_t past_at() const { return motion_at(uavs_) + joints(); }
  std::size_t joints() const { return first_joint_.back(); }  ///< of all UAVs together

  uav::Pose pose_of(const std::vector<double>& state, std::size_t body) const;
  BodyMotion motion_of(const std::vector<double>& state, std::size_t uav) const;
  /// Of all joints of a UAV, from the body outwards.
  std::span<const double> angles_of(const std::vector<double>& state, std::size_t uav) const;
  /// Where a body was so many steps before the capture. @pre within the longest shutter.
  uav::Pose past_pose_of(const std::vector<double>& state, std::size_t body,
                         std::size_t steps_ago) const;
  /// Where a sensor of a UAV was, in its body, so many steps before the capture.
  uav::Pose mounting(const std::vector<double>& state, const World& world, std::size_t uav,
                     const Sensor& sensor, std::size_t steps_ago = 0) const {
    return turned_pose(state, world, {uav, sensor.joints}, sensor.X_BS, steps_ago);
  }
  /// The same of anything on a part, whose pose in the UAV's body is `X_B0` while joints are at 0.
  uav::Pose turned_pose(const std::vector<double>& state, const World& world,
                        const TurnedPart& part, const uav::Pose& X_B0, std::size_t steps_ago) const;
  /// How many numbers the past of one step has.
  std::size_t row_size() const;

 private:
  std::size_t bodies_;
  std::size_t uavs_;
  std::size_t past_steps_;
  std::vector<std::size_t> first_joint_;  // of each UAV, and the end
};

/// Writes the states that StateLayout reads. A back end passes the poses of its moving bodies, in
/// the order of `moving_bodies`, before each step; the recorder keeps those that the shutters need.
/// Allocates at construction only. One thread at a time.
class StateRecorder {
 public:
  /// @throws Error(kBadFile) as `shutter_steps` does.
  explicit StateRecorder(const World& world);

  const StateLayout& layout() const { return layout_; }

  /// Back to ST 0: as if nothing had moved before.
  void reset(std::span<const uav::Pose> X_WB);
  /// A step begins with these poses. Steps that are further back than `layout().past_steps()` at
  /// the next capture may be left out.
  void begin_step(std::span<const uav::Pose> X_WB);
  /// Turned by each step that begins.
  JointDrives& joints() { return joints_; }
  const JointDrives& joints() const { return joints_; }
  /// The state with these poses and, of each UAV, this motion. Allocates nothing for a `state` that
  /// was captured before.
  void capture(std::span<const uav::Pose> X_WB, std::span<const BodyMotion> motions,
               std::vector<double>& state) const;

 private:
  StateLayout layout_;
  JointDrives joints_;
  std::size_t oldest_ = 0;
  std::vector<double> past_;  // a ring of steps
};

}  // namespace tether::sim
