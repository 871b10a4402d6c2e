#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include <tether/tasks/task.h>

namespace tether::tasks {
namespace {

/// The end of the whole that the end of its `number`th task is.
TaskOutcome ended_by(const TaskOutcome& part, std::size_t number, const std::string& why) {
  TaskOutcome whole;
  whole.status = part.status == TaskStatus::kFailed ? part.status : TaskStatus::kNotReached;
  whole.reason = "task " + std::to_string(number) + " (" + part.task + "): " + why;
  whole.failure = part.failure;
  return whole;
}

std::string late(Duration by) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.3f s late", to_seconds(by));
  return text.data();
}

}  // namespace

TaskSequence::TaskSequence(std::vector<SequenceItem> items) : items_(std::move(items)) {}

Progress TaskSequence::initialise(TaskContext& context) {
  started_at_ = context.vehicle().now();
  parts_.clear();
  missed_.reset();
  next_ = 0;
  return items_.empty() ? Progress(TaskOutcome::goal_reached()) : std::nullopt;
}

Progress TaskSequence::step(TaskContext& context) {
  const std::size_t number = next_ + 1;
  const SequenceItem& item = items_[next_];
  const ExecTime began_at = context.vehicle().now();
  const TaskOutcome& part = run_item(item, context);
  const std::string why = why_missed(item, began_at, context.vehicle().now());
  ++next_;
  if (part.status == TaskStatus::kFailed) return ended_by(part, number, part.reason);
  if (!why.empty() && item.otherwise) {
    if (!missed_) missed_ = ended_by(part, number, why);
    next_ = *item.otherwise;
  } else if (!why.empty() && item.required) {
    return ended_by(part, number, why);
  }
  if (next_ < items_.size()) return std::nullopt;
  return missed_ ? *missed_ : TaskOutcome::goal_reached();
}

/// With its repetitions.
const TaskOutcome& TaskSequence::run_item(const SequenceItem& item, TaskContext& context) {
  const std::string_view name = item.name.empty() ? item.task->name() : item.name;
  for (int repetition = 0;; ++repetition) {
    context.look_with(item.vision);
    context.note_mission(name, "start");
    parts_.push_back(run(*item.task, context));
    const TaskOutcome& part = parts_.back();
    context.note_mission(name, "end", tasks::name(part.status), part.reason);
    if (part.status != TaskStatus::kNotReached || repetition == item.retry) return part;
  }
}

/// Of the item that ran last; empty if it did not miss.
std::string TaskSequence::why_missed(const SequenceItem& item, ExecTime began_at,
                                     ExecTime now) const {
  if (!parts_.back().reached()) return parts_.back().reason;
  const Duration since_start = now - began_at, in_all = now - started_at_;
  if (item.within && since_start > *item.within) return late(since_start - *item.within);
  if (item.before && in_all > *item.before) return late(in_all - *item.before);
  return "";
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
