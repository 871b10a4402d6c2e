#include "motion.h"

#include <utility>

#include <tether/tasks/mission_tasks.h>
#include <tether/tasks/task.h>

namespace tether::tasks {

SearchTask::SearchTask(std::string anchor, const SearchOptions& options)
    : anchor_(std::move(anchor)),
      options_(options),
      limit_(options.time_limit, options.max_images) {}

Progress SearchTask::initialise(TaskContext& context) {
  limit_.start(context.vehicle().now());
  images_ = seen_in_a_row_ = 0;
  bearing_rad_.reset();
  const double sign = options_.clockwise ? -1.0 : 1.0;
  const Status turning = turn(context, sign * options_.yaw_rate_rad_s);
  return turning ? std::nullopt : Progress(TaskOutcome::failed(turning.failure()));
}

Progress SearchTask::step(TaskContext& context) {
  if (Progress end = limit_.next_round(context.vehicle().now())) return end;
  const Result<std::optional<Sight>> sight = look(context, anchor_);
  if (!sight) return TaskOutcome::failed(sight.failure());
  ++images_;
  seen_in_a_row_ = *sight ? seen_in_a_row_ + 1 : 0;
  bearing_rad_.reset();
  if (*sight) bearing_rad_ = (*sight)->position.bearing_rad;
  return seen_in_a_row_ >= options_.frames ? Progress(TaskOutcome::goal_reached()) : std::nullopt;
}

void SearchTask::finalise(TaskContext& context, TaskOutcome& outcome) {
  fail_on(stop(context), outcome);
  outcome.results["duration_s"] = to_seconds(limit_.elapsed(context.vehicle().now()));
  outcome.results["images"] = images_;
  if (bearing_rad_) outcome.results["bearing_rad"] = *bearing_rad_;
}

}  // namespace tether::tasks
