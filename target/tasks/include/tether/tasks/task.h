#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/result.h>
#include <tether/base/time.h>

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

}  // namespace tether::tasks
