#include "motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <tether/tasks/mission_tasks.h>
#include <tether/tasks/task.h>

namespace tether::tasks {

InspectTask::InspectTask(std::string anchor, const InspectOptions& options)
    : anchor_(std::move(anchor)),
      options_(options),
      limit_(options.time_limit, options.max_images) {}

Progress InspectTask::initialise(TaskContext& context) {
  seen_at_ = context.vehicle().now();
  limit_.start(seen_at_);
  images_ = 0;
  held_since_.reset();
  held_ = Duration(0);
  bearing_rad_.reset();
  distance_m_.reset();
  return std::nullopt;
}

Progress InspectTask::step(TaskContext& context) {
  if (Progress end = limit_.next_round(context.vehicle().now())) return end;
  const Result<std::optional<Sight>> sight = look(context, anchor_);
  if (!sight) return TaskOutcome::failed(sight.failure());
  ++images_;
  if (options_.least_charge > 0.0) {
    const Result<uav::BatterySample> battery = context.vehicle().read_battery();
    if (!battery) return TaskOutcome::failed(battery.failure());
    if (battery->charge < options_.least_charge) return TaskOutcome::not_reached("battery low");
  }
  if (!*sight || !(*sight)->position.distance_m) {
    held_since_.reset();
    if (context.vehicle().now() - seen_at_ > options_.lost_limit)
      return TaskOutcome::not_reached("anchor lost");
    const Status stopped = stop(context);
    return stopped ? std::nullopt : Progress(TaskOutcome::failed(stopped.failure()));
  }
  seen_at_ = context.vehicle().now();
  bearing_rad_ = (*sight)->position.bearing_rad;
  distance_m_ = (*sight)->position.distance_m;
  const double too_far_m = *distance_m_ - options_.distance_m;
  const double speed_m_s =
      std::clamp(options_.speed_gain_per_s * too_far_m, -options_.speed_m_s, options_.speed_m_s);
  const double yaw_rate_rad_s = std::clamp(options_.yaw_gain_per_s * *bearing_rad_,
                                           -options_.yaw_rate_rad_s, options_.yaw_rate_rad_s);
  const Status moving =
      context.vehicle().command_velocity({speed_m_s * level(*bearing_rad_), yaw_rate_rad_s});
  if (!moving) return TaskOutcome::failed(moving.failure());

  const bool is_held = std::abs(too_far_m) <= options_.distance_tolerance_m &&
                       std::abs(*bearing_rad_) <= options_.bearing_tolerance_rad;
  if (!is_held) held_since_.reset();
  if (is_held && !held_since_) held_since_ = (*sight)->sampled_at;
  if (held_since_) held_ = std::max(held_, (*sight)->sampled_at - *held_since_);
  return held_ >= options_.duration ? Progress(TaskOutcome::goal_reached()) : std::nullopt;
}

void InspectTask::finalise(TaskContext& context, TaskOutcome& outcome) {
  fail_on(stop(context), outcome);
  outcome.results["duration_s"] = to_seconds(limit_.elapsed(context.vehicle().now()));
  outcome.results["images"] = images_;
  outcome.results["held_s"] = to_seconds(held_);
  if (bearing_rad_) outcome.results["bearing_rad"] = *bearing_rad_;
  if (distance_m_) outcome.results["distance_m"] = *distance_m_;
}

}  // namespace tether::tasks
