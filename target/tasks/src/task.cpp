#include <utility>

#include <nlohmann/json.hpp>

#include <tether/tasks/task.h>

namespace tether::tasks {

namespace {

nlohmann::json details_of(const TaskOutcome& outcome) {
  nlohmann::json details = {
      {"status", name(outcome.status)}, {"reason", outcome.reason}, {"results", outcome.results}};
  for (const TaskOutcome& part : outcome.parts) {
    details["tasks"].push_back(details_of(part));
    details["tasks"].back()["task"] = part.task;
  }
  return details;
}

}  // namespace

std::string_view name(TaskStatus status) {
  switch (status) {
    case TaskStatus::kReached:
      return "reached";
    case TaskStatus::kNotReached:
      return "not_reached";
    case TaskStatus::kFailed:
      return "failed";
  }
  return "unknown";
}

TaskOutcome TaskOutcome::not_reached(std::string reason) {
  return {TaskStatus::kNotReached, std::move(reason), {}, {}};
}

TaskOutcome TaskOutcome::failed(const Failure& failure) {
  return {TaskStatus::kFailed, failure.message, failure.kind, {}};
}

std::string details_json(const TaskOutcome& outcome) {
  return details_of(outcome).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

TaskOutcome run(Task& task, TaskContext& context) {
  context.note_event(task.name(), "initialise", "start");
  Progress progress = task.initialise(context);
  if (!progress) context.note_event(task.name(), "loop", "start");
  while (!progress) {
    const client::Stage stage(context.vehicle(), "decide");
    progress = task.step(context);
  }
  context.note_event(task.name(), "finalise", "start");
  task.finalise(context, *progress);
  progress->task = task.name();
  context.note_end(task.name(), name(progress->status), progress->reason);
  return *std::move(progress);
}

}  // namespace tether::tasks
