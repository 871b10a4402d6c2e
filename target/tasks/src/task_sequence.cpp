#include <algorithm>
#include <utility>

#include <tether/tasks/task_sequence.h>

namespace tether::tasks {
namespace {

/// The end of the whole that the end of its `number`th task is.
TaskOutcome ended_by(const TaskOutcome& part, std::size_t number) {
  TaskOutcome whole;
  whole.status = part.status;
  whole.reason = "task " + std::to_string(number) + " (" + part.task + "): " + part.reason;
  whole.failure = part.failure;
  return whole;
}

}  // namespace

TaskSequence::TaskSequence(std::vector<SequenceItem> items) : items_(std::move(items)) {}

Progress TaskSequence::initialise(TaskContext& context) {
  started_at_ = context.vehicle().now();
  parts_.clear();
  return items_.empty() ? Progress(TaskOutcome::goal_reached()) : std::nullopt;
}

Progress TaskSequence::step(TaskContext& context) {
  const SequenceItem& item = items_[parts_.size()];
  context.look_with(item.vision);
  parts_.push_back(run(*item.task, context));
  const TaskOutcome& part = parts_.back();
  if (part.status == TaskStatus::kFailed || (item.required && !part.reached())) {
    return ended_by(part, parts_.size());
  }
  return parts_.size() == items_.size() ? Progress(TaskOutcome::goal_reached()) : std::nullopt;
}

void TaskSequence::finalise(TaskContext& context, TaskOutcome& outcome) {
  const auto reached = std::count_if(parts_.begin(), parts_.end(),
                                     [](const TaskOutcome& part) { return part.reached(); });
  outcome.results["duration_s"] = to_seconds(context.vehicle().now() - started_at_);
  outcome.results["tasks_run"] = static_cast<double>(parts_.size());
  outcome.results["tasks_reached"] = static_cast<double>(reached);
  outcome.parts = parts_;
}

}  // namespace tether::tasks
