#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tether/base/result.h>
#include <tether/client/vehicle.h>
#include <tether/vision/anchor_tracker.h>
#include <tether/vision/relative_position.h>

namespace tether::tasks {

/// The camera and tracker of a task.
struct VisionOptions {
  std::string camera = "camera";  ///< name of the sensor
  vision::TrackerOptions tracker;
};

/// What nested tasks share: the UAV, and the trackers, so that a task in a loop continues to track.
/// `vehicle` must outlive it. Not thread-safe.
class TaskContext {
 public:
  explicit TaskContext(client::Vehicle& vehicle, VisionOptions vision = {});

  client::Vehicle& vehicle() { return vehicle_; }

  const VisionOptions& vision() const { return vision_; }
  /// Sets the options and resets all trackers. Must not be called while a task tracks an anchor.
  void look_with(VisionOptions vision);

  /// Fails (kInvalid) if the UAV has no sensor of this name.
  Result<const uav::SensorDescription*> sensor(std::string_view name) const;
  /// Fails (kInvalid) if the UAV has no sensor of this name and kind.
  Result<const uav::SensorDescription*> sensor(std::string_view name, uav::SensorKind kind) const;
  /// The camera of the vision options. Fails (kInvalid) if the UAV does not have it.
  Result<const uav::SensorDescription*> camera() const;
  /// Fails (kInvalid) if there is no such anchor.
  Result<const uav::Anchor*> anchor(std::string_view name) const;
  /// The tracker of this anchor, valid until `look_with`. Fails (kInvalid) if there is no such
  /// anchor, or its colour cannot be tracked.
  Result<vision::AnchorTracker*> tracker(std::string_view anchor);

  /// Reads the camera under the stage "capture".
  Result<uav::CameraSample> capture(const std::string& camera);
  /// Finds the anchor of the tracker in the image under the stage "detect".
  std::optional<vision::Roi> detect(vision::AnchorTracker& tracker, const uav::CameraSample& image);

  /// @name Annotations in the record (topics "task", "mission", "roi", "estimate", "odometry",
  /// "displacement"). If sending fails, the next interaction reports it. The camera of a ROI or an
  /// estimate is that of the vision options.
  /// @{
  using Values = std::vector<std::pair<std::string_view, double>>;
  void note_event(std::string_view task, std::string_view phase, std::string_view event,
                  const Values& values = {});
  void note_end(std::string_view task, std::string_view status, std::string_view reason);
  /// A task of a mission starts or ends (topic "mission"). `status` and `reason`: how it ended.
  void note_mission(std::string_view task, std::string_view event, std::string_view status = {},
                    std::string_view reason = {});
  void note_roi(const vision::Roi& roi, std::uint64_t image_index);
  void note_estimate(std::string_view anchor, std::uint64_t image_index,
                     const vision::RelativePosition& estimate, bool converged);
  /// Position and yaw by dead reckoning in the start-heading frame H0 (x ahead at the start, y
  /// left, origin at the start) [m, rad].
  void note_odometry(const uav::Vec3& p_H0B, double yaw_rad);
  /// Algorithm 5's estimate of end minus start, in H0 [m].
  void note_displacement(const uav::Vec3& p_H0B);
  /// @}

 private:
  client::Vehicle& vehicle_;
  VisionOptions vision_;
  std::map<std::string, vision::AnchorTracker, std::less<>> trackers_;
};

}  // namespace tether::tasks
