#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/result.h>

namespace tether::tasks {

class TaskContext;

enum class TaskStatus {
  kReached,     ///< the task did what it is for
  kNotReached,  ///< it ran as it should, but the goal was not reached within its limits
  kFailed,      ///< it could not run: the UAV refused something or is gone
};
std::string_view name(TaskStatus status);

/// How a task ended.
struct TaskOutcome {
  TaskStatus status = TaskStatus::kReached;
  std::string reason;  ///< a short phrase: "goal reached", "time limit", "anchor lost", …
  std::optional<Failure::Kind> failure;   ///< of what failed, if kFailed
  std::map<std::string, double> results;  ///< figures by name; names carry units
  std::string task = {};                  ///< the task's name; `run` sets it
  std::vector<TaskOutcome> parts = {};    ///< of the tasks that a sequence is made of, in order

  bool reached() const { return status == TaskStatus::kReached; }
  static TaskOutcome goal_reached() { return {TaskStatus::kReached, "goal reached", {}, {}}; }
  static TaskOutcome not_reached(std::string reason);
  static TaskOutcome failed(const Failure& failure);
};

/// {"status", "reason", "results": {…}}, for Vehicle::finish; for a sequence also "tasks":
/// [{"task", "status", "reason", "results"}, …]. A figure that is not finite becomes null.
std::string details_json(const TaskOutcome& outcome);

/// What a phase says: nothing (go on), or how the task ended.
using Progress = std::optional<TaskOutcome>;

/// A self-contained operation in three phases (paper, Section III). Call order, by `run` alone:
/// initialise, then step until one of them ends the task, then finalise, whatever the end was. A
/// task may `run` another one in any phase, and may be run again afterwards. Throws nothing. One
/// thread.
class Task {
 public:
  virtual ~Task() = default;
  /// In the record: "face_anchor".
  virtual std::string_view name() const = 0;

  virtual Progress initialise(TaskContext& context) = 0;
  /// One round of the task loop: sense, compute, command. Every loop ends: bounded by the task
  /// itself.
  virtual Progress step(TaskContext& context) = 0;
  /// Gives control back. May add results, and fail what had not failed before.
  virtual void finalise(TaskContext& context, TaskOutcome& outcome) = 0;
};

/// Runs a task from beginning to end; notes each phase in the record.
TaskOutcome run(Task& task, TaskContext& context);

}  // namespace tether::tasks
