#include "convergence.h"

#include <utility>

#include <tether/tasks/paper_tasks.h>
#include <tether/tasks/task.h>

namespace tether::tasks {

struct RelativePositionTask::Loop {
  const uav::SensorDescription* camera = nullptr;
  const uav::Anchor* anchor = nullptr;
  vision::AnchorTracker* tracker = nullptr;
  ConvergenceMonitor convergence;
  int frames = 0;
  int unseen_in_a_row = 0;
};

RelativePositionTask::RelativePositionTask(std::string anchor,
                                           const RelativePositionOptions& options)
    : anchor_(std::move(anchor)),
      options_(options),
      limit_(options.time_limit, options.convergence.max_frames) {}

RelativePositionTask::~RelativePositionTask() = default;

Progress RelativePositionTask::initialise(TaskContext& context) {
  limit_.start(context.vehicle().now());
  estimate_.reset();
  sighting_.reset();
  loop_.reset();
  return prepare(context);
}

Progress RelativePositionTask::prepare(TaskContext& context) {
  const auto camera = context.camera();
  if (!camera) return TaskOutcome::failed(camera.failure());
  const auto anchor = context.anchor(anchor_);
  if (!anchor) return TaskOutcome::failed(anchor.failure());
  const auto tracker = context.tracker(anchor_);
  if (!tracker) return TaskOutcome::failed(tracker.failure());
  loop_ = std::make_unique<Loop>(
      Loop{*camera, *anchor, *tracker, ConvergenceMonitor(options_.convergence), 0, 0});
  return std::nullopt;
}

Progress RelativePositionTask::step(TaskContext& context) {
  if (Progress end = limit_.next_round(context.vehicle().now())) return end;
  Result<uav::CameraSample> image = context.capture(loop_->camera->name);
  if (!image) return TaskOutcome::failed(image.failure());
  ++loop_->frames;
  if (Progress progress = look(context, std::move(image).value())) return progress;
  if (loop_->frames >= options_.convergence.max_frames) {
    return TaskOutcome::not_reached(estimate_ ? "did not converge" : "anchor not seen");
  }
  return std::nullopt;
}

Progress RelativePositionTask::look(TaskContext& context, uav::CameraSample image) {
  const std::optional<vision::Roi> roi = context.detect(*loop_->tracker, image);
  if (!roi) return miss();
  loop_->unseen_in_a_row = 0;
  loop_->convergence.see(image.sampled_at, *roi);
  const bool converged = loop_->convergence.has_converged();
  estimate_ = vision::relative_position(*loop_->camera, *loop_->anchor, *roi);
  context.note_roi(*roi, image.index);
  context.note_estimate(anchor_, image.index, *estimate_, converged);
  sighting_ = Sighting{std::move(image), *roi};
  return converged ? Progress(TaskOutcome::goal_reached()) : std::nullopt;
}

Progress RelativePositionTask::miss() {
  loop_->convergence.miss();
  if (++loop_->unseen_in_a_row >= options_.convergence.max_unseen_frames) {
    return TaskOutcome::not_reached("anchor not seen");
  }
  return std::nullopt;
}

void RelativePositionTask::finalise(TaskContext& context, TaskOutcome& outcome) {
  outcome.results["duration_s"] = to_seconds(limit_.elapsed(context.vehicle().now()));
  outcome.results["frames"] = loop_ ? loop_->frames : 0;
  if (!estimate_) return;
  outcome.results["bearing_rad"] = estimate_->bearing_rad;
  if (estimate_->distance_m) outcome.results["distance_m"] = *estimate_->distance_m;
}

}  // namespace tether::tasks
