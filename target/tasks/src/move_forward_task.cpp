#include "motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <tether/tasks/paper_tasks.h>
#include <tether/tasks/task.h>

namespace tether::tasks {

FaceAnchorOptions facing_under_way() {
  FaceAnchorOptions options;
  options.precision_rad = rad_from_deg(2.0);
  options.slowdown = 0.9;
  options.min_yaw_rate_rad_s = rad_from_deg(16.0);
  return options;
}

MoveForwardTask::MoveForwardTask(std::string anchor, const MoveForwardOptions& options)
    : anchor_(std::move(anchor)),
      options_(options),
      limit_(options.time_limit, options.max_rounds),
      relative_position_(anchor_, {options.face.convergence, options.time_limit}) {}

Progress MoveForwardTask::initialise(TaskContext& context) {
  limit_.start(context.vehicle().now());
  bearing_rad_.reset();
  yaw_turned_rad_ = 0.0;
  in_sight_ = false;
  face_anchors_ = missed_ = looks_ = 0;
  overshoots_ = 0.0;

  const Result<double> yaw = get_yaw(context, options_.face.imu);
  if (!yaw) return TaskOutcome::failed(yaw.failure());
  starting_yaw_rad_ = *yaw;
  if (const Status moving = move_direction(context, 0.0, options_.speed_m_s); !moving) {
    return TaskOutcome::failed(moving.failure());
  }
  return std::nullopt;
}

Progress MoveForwardTask::step(TaskContext& context) {
  if (in_sight_ && std::abs(yaw_turned_rad_) >= 0.5 * std::numbers::pi) {
    return TaskOutcome::goal_reached();
  }
  if (Progress end = limit_.next_round(context.vehicle().now())) return end;
  bool is_ahead = false;
  if (Progress end = look(context, is_ahead)) return end;
  if (!is_ahead) {
    if (Progress end = face_anchor(context)) return end;
  }
  if (Progress end = update_yaw(context)) return end;
  const Status moving = move_direction(context, -yaw_turned_rad_, options_.speed_m_s);
  return moving ? std::nullopt : Progress(TaskOutcome::failed(moving.failure()));
}

/// Algorithm 2. An estimate that did not converge is used all the same; an anchor that is not seen
/// is not ahead.
Progress MoveForwardTask::look(TaskContext& context, bool& is_ahead) {
  const TaskOutcome outcome = run(relative_position_, context);
  ++looks_;
  if (outcome.status == TaskStatus::kFailed) return outcome;
  in_sight_ = relative_position_.estimate().has_value();
  if (const auto& estimate = relative_position_.estimate()) {
    bearing_rad_ = estimate->bearing_rad;
    is_ahead = std::abs(estimate->bearing_rad) <= options_.precision_rad;
  }
  return std::nullopt;
}

/// Algorithm 3, for no longer than this task may last. An anchor out of sight is looked for on the
/// side of the way where it was last: moving on takes it further to that side.
Progress MoveForwardTask::face_anchor(TaskContext& context) {
  FaceAnchorOptions options = options_.face;
  if (bearing_rad_) {
    options.search_clockwise = wrap_angle_rad(yaw_turned_rad_ + *bearing_rad_) < 0.0;
  }
  if (!options_.stop_to_face) options.course = Course{starting_yaw_rad_, options_.speed_m_s};
  options.time_limit = std::min(options.time_limit, limit_.left(context.vehicle().now()));
  FaceAnchorTask face(anchor_, options);
  const TaskOutcome outcome = run(face, context);
  ++face_anchors_;
  looks_ += face.looks();
  in_sight_ = face.is_in_sight();
  overshoots_ += outcome.results.at("overshoots");
  if (face.bearing_rad()) bearing_rad_ = face.bearing_rad();
  if (outcome.status == TaskStatus::kFailed) return outcome;
  if (face.has_lost_anchor()) {
    return TaskOutcome::not_reached(bearing_rad_ ? "anchor lost" : "anchor never seen");
  }
  missed_ += outcome.reached() ? 0 : 1;
  return std::nullopt;
}

Progress MoveForwardTask::update_yaw(TaskContext& context) {
  const Result<double> yaw = get_yaw(context, options_.face.imu);
  if (!yaw) return TaskOutcome::failed(yaw.failure());
  yaw_turned_rad_ = wrap_angle_rad(*yaw - starting_yaw_rad_);
  return std::nullopt;
}

/// Comes to rest: by the instants of the IMU's readings, which are simulated time under every
/// policy. Fails (kInvalid) if the timestamps do not advance.
Status MoveForwardTask::settle(TaskContext& context, const TaskOutcome& outcome) {
  const bool is_needed =
      outcome.status != TaskStatus::kFailed && options_.settle_time > Duration::zero();
  return is_needed ? pause(context, options_.face.imu, options_.settle_time) : ok_status();
}

void MoveForwardTask::finalise(TaskContext& context, TaskOutcome& outcome) {
  fail_on(stop(context), outcome);
  outcome.results["duration_s"] = to_seconds(limit_.elapsed(context.vehicle().now()));
  outcome.results["yaw_turned_rad"] = yaw_turned_rad_;
  outcome.results["face_anchors"] = face_anchors_;
  outcome.results["face_anchors_missed"] = missed_;
  outcome.results["looks"] = looks_;
  outcome.results["overshoots"] = overshoots_;
  if (bearing_rad_) outcome.results["bearing_rad"] = *bearing_rad_;
  fail_on(settle(context, outcome), outcome);
}

}  // namespace tether::tasks
