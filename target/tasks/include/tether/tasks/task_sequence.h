#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/tasks/task.h>
#include <tether/tasks/task_context.h>

namespace tether::tasks {

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
