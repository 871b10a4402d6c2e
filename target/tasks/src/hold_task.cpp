#include "motion.h"

#include <tether/tasks/mission_tasks.h>
#include <tether/tasks/task.h>

namespace tether::tasks {

Progress HoldTask::initialise(TaskContext& context) {
  started_at_ = context.vehicle().now();
  const Status stopped = stop(context);
  return stopped ? std::nullopt : Progress(TaskOutcome::failed(stopped.failure()));
}

Progress HoldTask::step(TaskContext& context) {
  const Status held = pause(context, options_.imu, options_.duration);
  return held ? TaskOutcome::goal_reached() : TaskOutcome::failed(held.failure());
}

void HoldTask::finalise(TaskContext& context, TaskOutcome& outcome) {
  outcome.results["duration_s"] = to_seconds(context.vehicle().now() - started_at_);
}

}  // namespace tether::tasks
