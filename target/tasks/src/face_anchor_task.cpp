#include "motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <tether/tasks/paper_tasks.h>
#include <tether/tasks/task.h>

namespace tether::tasks {
namespace {

double sign_of(double value) {
  return value < 0.0 ? -1.0 : 1.0;
}

}  // namespace

FaceAnchorTask::FaceAnchorTask(std::string anchor, const FaceAnchorOptions& options)
    : options_(options),
      limit_(options.time_limit, options.max_looks),
      relative_position_(std::move(anchor), {options.convergence, options.time_limit}) {}

Progress FaceAnchorTask::initialise(TaskContext& context) {
  last_seen_at_ = context.vehicle().now();
  limit_.start(last_seen_at_);
  bearing_rad_.reset();
  yaw_rate_rad_s_ = options_.yaw_rate_rad_s;
  overshoots_ = 0;
  looks_ = 0;
  lost_ = false;
  in_sight_ = true;

  if (const Status still = turn(context, 0.0); !still) return TaskOutcome::failed(still.failure());
  std::optional<double> bearing;
  if (Progress end = look(context, bearing)) return end;
  if (!bearing) {
    return turn_to(context, "initialise", options_.search_clockwise ? -1.0 : 1.0, "search");
  }
  bearing_rad_ = bearing;
  return turn_to(context, "initialise", sign_of(*bearing), "rotate");
}

Progress FaceAnchorTask::step(TaskContext& context) {
  if (Progress end = limit_.next_round(context.vehicle().now())) return end;
  std::optional<double> bearing;
  if (Progress end = look(context, bearing)) return end;
  if (!bearing) return keep_searching(context);
  const bool overshot = bearing_rad_ && sign_of(*bearing_rad_) != sign_of(*bearing);
  bearing_rad_ = bearing;
  if (overshot) {
    ++overshoots_;
    yaw_rate_rad_s_ = std::max(yaw_rate_rad_s_ * options_.slowdown, options_.min_yaw_rate_rad_s);
    return turn_to(context, "loop", sign_of(*bearing), "reverse");
  }
  if (direction_ != sign_of(*bearing)) return turn_to(context, "loop", sign_of(*bearing), "rotate");
  return hold_course(context);
}

/// Algorithm 2. Ends the task if the goal is reached or the UAV is gone. An estimate that did not
/// converge is used all the same: to turn on past the anchor would be worse.
Progress FaceAnchorTask::look(TaskContext& context, std::optional<double>& bearing_rad) {
  const TaskOutcome outcome = run(relative_position_, context);
  ++looks_;
  if (outcome.status == TaskStatus::kFailed) return outcome;
  in_sight_ = relative_position_.estimate().has_value();
  if (!in_sight_) return std::nullopt;
  bearing_rad = relative_position_.estimate()->bearing_rad;
  last_seen_at_ = context.vehicle().now();
  if (outcome.reached() && std::abs(*bearing_rad) <= options_.precision_rad) {
    bearing_rad_ = bearing_rad;
    return TaskOutcome::goal_reached();
  }
  return std::nullopt;
}

Progress FaceAnchorTask::turn_to(TaskContext& context, std::string_view phase, double direction,
                                 std::string_view event) {
  direction_ = direction;
  if (Progress end = keep_turning(context)) return end;
  context.note_event(name(), phase, event, {{"yaw_rate_rad_s", direction_ * yaw_rate_rad_s_}});
  return std::nullopt;
}

Status FaceAnchorTask::turn(TaskContext& context, double yaw_rate_rad_s) const {
  return options_.course && in_sight_
             ? turn_on_course(context, yaw_rate_rad_s, *options_.course, options_.imu)
             : tasks::turn(context, yaw_rate_rad_s);
}

Progress FaceAnchorTask::keep_turning(TaskContext& context) {
  const Status turning = turn(context, direction_ * yaw_rate_rad_s_);
  return turning ? std::nullopt : Progress(TaskOutcome::failed(turning.failure()));
}

/// Under way, the heading of the last command has become another one; on the spot, nothing changes.
Progress FaceAnchorTask::hold_course(TaskContext& context) {
  return options_.course ? keep_turning(context) : std::nullopt;
}

/// Turns on as before, for a while.
Progress FaceAnchorTask::keep_searching(TaskContext& context) {
  if (context.vehicle().now() - last_seen_at_ > options_.lost_limit) {
    lost_ = true;
    return TaskOutcome::not_reached(bearing_rad_ ? "anchor lost" : "anchor never seen");
  }
  context.note_event(name(), "loop", "unseen");
  return hold_course(context);
}

void FaceAnchorTask::finalise(TaskContext& context, TaskOutcome& outcome) {
  fail_on(turn(context, 0.0), outcome);
  outcome.results["overshoots"] = overshoots_;
  outcome.results["looks"] = looks_;
  outcome.results["duration_s"] = to_seconds(limit_.elapsed(context.vehicle().now()));
  outcome.results["yaw_rate_rad_s"] = yaw_rate_rad_s_;
  if (bearing_rad_) outcome.results["bearing_rad"] = *bearing_rad_;
}

}  // namespace tether::tasks
