#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <tether/sim/joint_drives.h>
#include <tether/sim/world.h>
#include <tether/sim_sensing/state_layout.h>

namespace tether::sim {

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
