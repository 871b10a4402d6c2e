#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tether/base/result.h>
#include <tether/client/vehicle.h>
#include <tether/vision/anchor_tracker.h>
#include <tether/vision/relative_position.h>

namespace tether::tasks {

/// How a task looks at the world.
struct VisionOptions {
  std::string camera = "camera";  ///< a sensor's name
  vision::TrackerOptions tracker;
};

/// What tasks that run in one another share: the UAV, and the trackers, so that a task that is run
/// in a loop goes on tracking where it stopped. `vehicle` must outlive it. One thread.
class TaskContext {
 public:
  explicit TaskContext(client::Vehicle& vehicle, VisionOptions vision = {});

  client::Vehicle& vehicle() { return vehicle_; }

  /// From now on; forgets what was tracked. Not while a task is looking.
  void look_with(VisionOptions vision);

  /// Fails (kInvalid) if the UAV has no sensor of this name.
  Result<const uav::SensorDescription*> sensor(std::string_view name) const;
  /// Fails (kInvalid) if the UAV has no sensor of this name and kind.
  Result<const uav::SensorDescription*> sensor(std::string_view name, uav::SensorKind kind) const;
  /// Fails (kInvalid) if the UAV has no camera of the name that it looks with.
  Result<const uav::SensorDescription*> camera() const;
  /// Fails (kInvalid) if there is no such anchor.
  Result<const uav::Anchor*> anchor(std::string_view name) const;
  /// The one tracker of this anchor. Fails (kInvalid) if there is no such anchor, or its colour
  /// cannot be tracked. The pointer stays valid until
  /// `look_with`.
  Result<vision::AnchorTracker*> tracker(std::string_view anchor);

  /// @name Notes for the record (topics "task", "roi", "estimate", "odometry", "displacement"). An
  /// annotation that cannot be sent is no failure of its own: the link's next interaction tells.
  /// Which camera a ROI or an estimate is of is the one that it looks with.
  /// @{
  using Values = std::vector<std::pair<std::string_view, double>>;
  void note_event(std::string_view task, std::string_view phase, std::string_view event,
                  const Values& values = {});
  void note_end(std::string_view task, std::string_view status, std::string_view reason);
  void note_roi(const vision::Roi& roi, std::uint64_t image_index);
  void note_estimate(std::string_view anchor, std::uint64_t image_index,
                     const vision::RelativePosition& estimate, bool converged);
  /// Where dead reckoning has the UAV, in the start-heading frame H0 (x ahead at the start, y left,
  /// origin at the start) [m, rad].
  void note_odometry(const uav::Vec3& p_H0B, double yaw_rad);
  /// Algorithm 5's own estimate of end minus start, in H0 [m].
  void note_displacement(const uav::Vec3& p_H0B);
  /// @}

 private:
  client::Vehicle& vehicle_;
  VisionOptions vision_;
  std::map<std::string, vision::AnchorTracker, std::less<>> trackers_;
};

}  // namespace tether::tasks
