#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/client/vehicle.h>
#include <tether/vision/anchor_tracker.h>

/// What every task is, and how long its loop may take.
namespace tether::tasks {

class TaskContext;

enum class TaskStatus {
  kReached,     ///< the task reached its goal
  kNotReached,  ///< it ran, but did not reach its goal within its limits
  kFailed,      ///< it could not run: a call was refused, or the UAV was lost
};
std::string_view name(TaskStatus status);

/// How a task ended.
struct TaskOutcome {
  TaskStatus status = TaskStatus::kReached;
  std::string reason;  ///< a short phrase: "goal reached", "time limit", "anchor lost", …
  std::optional<Failure::Kind> failure;   ///< of what failed, if kFailed
  std::map<std::string, double> results;  ///< values by name; names include units
  std::string task = {};                  ///< the task's name; `run` sets it
  std::vector<TaskOutcome> parts = {};    ///< of the tasks of a sequence, in order

  bool reached() const { return status == TaskStatus::kReached; }
  static TaskOutcome goal_reached() { return {TaskStatus::kReached, "goal reached", {}, {}}; }
  static TaskOutcome not_reached(std::string reason);
  static TaskOutcome failed(const Failure& failure);
};

/// {"status", "reason", "results": {…}}, for Vehicle::finish; for a sequence also "tasks":
/// [{"task", "status", "reason", "results"}, …]. A value that is not finite becomes null.
std::string details_json(const TaskOutcome& outcome);

/// Result of a phase: none to continue, or the outcome of the task.
using Progress = std::optional<TaskOutcome>;

/// A self-contained operation in three phases (paper, Section III). `run` calls initialise, then
/// step until one of them ends the task, then always finalise. A task can `run` another one in any
/// phase, and can run again afterwards. Throws nothing. Not thread-safe.
class Task {
 public:
  virtual ~Task() = default;
  /// Name in the record: "face_anchor".
  virtual std::string_view name() const = 0;

  virtual Progress initialise(TaskContext& context) = 0;
  /// One round of the task loop: sense, compute, command. Each task limits its loop.
  virtual Progress step(TaskContext& context) = 0;
  /// Ends the task. Can add results, and can turn the outcome into a failure.
  virtual void finalise(TaskContext& context, TaskOutcome& outcome) = 0;
};

/// Runs a task, and annotates each phase in the record.
TaskOutcome run(Task& task, TaskContext& context);

/// Ends a task loop that does not end by itself: after a time on the SUT's clock, or after a number
/// of rounds in case that clock is stopped. Not thread-safe.
class LoopLimit {
 public:
  /// @pre time_limit > 0, max_rounds > 0
  LoopLimit(Duration time_limit, int max_rounds)
      : time_limit_(time_limit), max_rounds_(max_rounds) {}

  /// Call once, when the task begins.
  void start(ExecTime now);
  /// Call at the beginning of each round. Returns "time limit" or "round limit" at the end.
  Progress next_round(ExecTime now);
  /// Time since `start`.
  Duration elapsed(ExecTime now) const { return now - started_at_; }
  /// What is left of the time limit; never negative.
  Duration left(ExecTime now) const {
    return std::max(time_limit_ - elapsed(now), Duration::zero());
  }

 private:
  Duration time_limit_;
  int max_rounds_;
  ExecTime started_at_;
  int rounds_ = 0;
};

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

struct SequenceItem {
  std::unique_ptr<Task> task = {};  ///< not null
  VisionOptions vision = {};        ///< of this task
  bool required = true;             ///< the sequence ends if a required task misses
  std::string name = {};            ///< in the record; empty: the task's
  int retry = 0;                    ///< how often it is repeated if it does not reach its goal
  /// Index of the later item that follows if this one misses, instead of the next one.
  std::optional<std::size_t> otherwise = {};
  /// Times on the SUT's clock, from the start of the task and of the sequence. A task that reaches
  /// its goal later misses, too.
  std::optional<Duration> within = {}, before = {};
};

/// Runs tasks one after the other, as one task: "a task can also include lower-level tasks" (paper,
/// Section III). Reaches its goal if all required tasks reach theirs. Ends with the first required
/// task that does not ("task 2 (face_anchor): anchor lost"), and with any task that fails. After a
/// miss with an `otherwise` it goes on there, and does not reach its goal.
///
/// Annotates each task in the record (topic "mission"), with its name and how it ended.
///
/// Its outcome has a part for each task that ran, and for each repetition. Results: "duration_s"
/// (ET), "tasks_run", "tasks_reached".
class TaskSequence : public Task {
 public:
  explicit TaskSequence(std::vector<SequenceItem> items);

  std::string_view name() const override { return "mission"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  const TaskOutcome& run_item(const SequenceItem& item, TaskContext& context);
  std::string why_missed(const SequenceItem& item, ExecTime began_at, ExecTime now) const;

  std::vector<SequenceItem> items_;

  // Of the current run.
  ExecTime started_at_;
  std::size_t next_ = 0;               ///< index of the item
  std::optional<TaskOutcome> missed_;  ///< the outcome because of the first miss with `otherwise`
  std::vector<TaskOutcome> parts_;
};

}  // namespace tether::tasks
