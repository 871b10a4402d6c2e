#pragma once

#include <memory>
#include <vector>

#include <tether/base/time.h>
#include <tether/tasks/task.h>
#include <tether/tasks/task_context.h>

namespace tether::tasks {

struct SequenceItem {
  std::unique_ptr<Task> task;  ///< not null
  VisionOptions vision;        ///< of this task
  bool required = true;        ///< the sequence ends if a required task does not reach its goal
};

/// Runs tasks one after the other, as one task: "a task can also include lower-level tasks" (paper,
/// Section III). Reaches its goal if all required tasks reach theirs. Ends with the first required
/// task that does not ("task 2 (face_anchor): anchor lost"), and with any task that fails.
///
/// Its outcome has a part for each task that ran. Results: "duration_s" (ET), "tasks_run",
/// "tasks_reached".
class TaskSequence : public Task {
 public:
  explicit TaskSequence(std::vector<SequenceItem> items);

  std::string_view name() const override { return "mission"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  std::vector<SequenceItem> items_;

  // Of the current run.
  ExecTime started_at_;
  std::vector<TaskOutcome> parts_;
};

}  // namespace tether::tasks
