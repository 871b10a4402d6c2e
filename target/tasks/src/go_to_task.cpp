#include "dead_reckoning.h"
#include "motion.h"

#include <algorithm>

#include <tether/tasks/mission_tasks.h>
#include <tether/tasks/task.h>

namespace tether::tasks {
namespace {

/// Speed for each metre that is left.
constexpr double kApproachGain_per_s = 0.8;

}  // namespace

GoToTask::GoToTask(const GoToOptions& options)
    : options_(options), limit_(options.time_limit, options.max_readings) {}

GoToTask::~GoToTask() = default;

Progress GoToTask::initialise(TaskContext& context) {
  limit_.start(context.vehicle().now());
  p_H0B_ = {};
  v_up_m_s_ = 0.0;
  const auto imu = context.sensor(options_.imu, uav::SensorKind::kImu);
  if (!imu) return TaskOutcome::failed(imu.failure());
  if (const Status stopped = stop(context); !stopped) return TaskOutcome::failed(stopped.failure());
  reckoning_ = std::make_unique<DeadReckoning>((*imu)->X_BS.q);
  return calibrate(context, options_.imu, {options_.settle_time, options_.rest_time}, limit_,
                   *reckoning_);
}

Progress GoToTask::step(TaskContext& context) {
  if (Progress end = limit_.next_round(context.vehicle().now())) return end;
  const Result<uav::ImuSample> reading = context.vehicle().read<uav::ImuSample>(options_.imu);
  if (!reading) return TaskOutcome::failed(reading.failure());
  p_H0B_.z += v_up_m_s_ * to_seconds(reading->sampled_at - reckoning_->read_at());
  reckoning_->update(*reading);
  p_H0B_ = {reckoning_->position_m().x, reckoning_->position_m().y, p_H0B_.z};
  context.note_odometry(p_H0B_, reckoning_->yaw_rad());
  const uav::Vec3 left_H0 = uav::Vec3{options_.ahead_m, options_.left_m, options_.up_m} - p_H0B_;
  const double left_m = norm(left_H0);
  if (left_m <= options_.tolerance_m) return TaskOutcome::goal_reached();
  const double speed_m_s = std::min(options_.speed_m_s, kApproachGain_per_s * left_m);
  const uav::Quat q_HH0 = uav::from_axis_angle({0, 0, 1}, -reckoning_->yaw_rad());
  const uav::Vec3 velocity_H = rotate(q_HH0, (speed_m_s / left_m) * left_H0);
  v_up_m_s_ = velocity_H.z;
  const Status moving = context.vehicle().command_velocity({velocity_H, 0.0});
  return moving ? std::nullopt : Progress(TaskOutcome::failed(moving.failure()));
}

void GoToTask::finalise(TaskContext& context, TaskOutcome& outcome) {
  fail_on(stop(context), outcome);
  outcome.results["duration_s"] = to_seconds(limit_.elapsed(context.vehicle().now()));
  outcome.results["end_x_m"] = p_H0B_.x;
  outcome.results["end_y_m"] = p_H0B_.y;
  outcome.results["end_z_m"] = p_H0B_.z;
}

}  // namespace tether::tasks
