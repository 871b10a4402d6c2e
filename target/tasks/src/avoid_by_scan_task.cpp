#include "motion.h"
#include "velocity_planner.h"

#include <tether/base/units.h>
#include <tether/tasks/mission_tasks.h>
#include <tether/tasks/task.h>

namespace tether::tasks {
namespace {

/// Speed and yaw rate for each metre of height and each radian of heading that is lost.
constexpr double kKeepHeight_per_s = 1.0;
constexpr double kKeepYaw_per_s = 1.0;

uav::Quat heading(const uav::Quat& q_WB) {
  return uav::from_axis_angle({0, 0, 1}, uav::yaw_rad(q_WB));
}

}  // namespace

AvoidByScanTask::AvoidByScanTask(const AvoidByScanOptions& options)
    : options_(options), limit_(options.time_limit, options.max_scans) {}

Progress AvoidByScanTask::initialise(TaskContext& context) {
  limit_.start(context.vehicle().now());
  scans_ = blocked_ = 0;
  p_H0B_ = {};
  const auto lidar = context.sensor(options_.lidar, uav::SensorKind::kScan);
  if (!lidar) return TaskOutcome::failed(lidar.failure());
  lidar_ = *lidar;
  const auto start = context.vehicle().read<uav::OdometrySample>(options_.odometry);
  if (!start) return TaskOutcome::failed(start.failure());
  X_WH0_ = {start->p_WS, heading(start->q_WS)};
  return std::nullopt;
}

Progress AvoidByScanTask::step(TaskContext& context) {
  if (Progress end = limit_.next_round(context.vehicle().now())) return end;
  const auto scan = context.vehicle().read<uav::ScanSample>(options_.lidar);
  if (!scan) return TaskOutcome::failed(scan.failure());
  const auto odometry =
      context.vehicle().read<uav::OdometrySample>(options_.odometry, client::Read::kLatest);
  if (!odometry) return TaskOutcome::failed(odometry.failure());
  ++scans_;
  p_H0B_ = transform(inverse(X_WH0_), odometry->p_WS);
  context.note_odometry(p_H0B_, uav::yaw_rad(inverse(X_WH0_.q) * odometry->q_WS));
  if (p_H0B_.x >= options_.distance_m) return TaskOutcome::goal_reached();
  const Status moving = context.vehicle().command_velocity(plan(context, *scan, *odometry, p_H0B_));
  return moving ? std::nullopt : Progress(TaskOutcome::failed(moving.failure()));
}

uav::VelocityCommand AvoidByScanTask::plan(TaskContext& context, const uav::ScanSample& scan,
                                           const uav::OdometrySample& odometry,
                                           const uav::Vec3& p_H0B) {
  const client::Stage stage(context.vehicle(), "plan");
  const uav::Quat q_HW = inverse(heading(odometry.q_WS));
  const uav::Vec3 v_H = rotate(q_HW, odometry.v_WS_m_s);
  // So far behind the line that the UAV does not slow down before it.
  const double goal_x_m = options_.distance_m + options_.speed_m_s * to_seconds(options_.horizon);
  const uav::Vec3 goal_H = rotate(q_HW * X_WH0_.q, uav::Vec3{goal_x_m, 0.0, 0.0} - p_H0B);
  const Plan best = plan_velocity(obstacles_of(*lidar_, scan, q_HW * odometry.q_WS), {v_H.x, v_H.y},
                                  {goal_H.x, goal_H.y}, options_);
  if (best.clearance_m <= 0.0) ++blocked_;
  return {{best.velocity_H_m_s.x, best.velocity_H_m_s.y, -kKeepHeight_per_s * p_H0B.z},
          -kKeepYaw_per_s * uav::yaw_rad(inverse(X_WH0_.q) * odometry.q_WS)};
}

void AvoidByScanTask::finalise(TaskContext& context, TaskOutcome& outcome) {
  fail_on(stop(context), outcome);
  outcome.results["duration_s"] = to_seconds(limit_.elapsed(context.vehicle().now()));
  outcome.results["scans"] = scans_;
  outcome.results["blocked"] = blocked_;
  outcome.results["end_x_m"] = p_H0B_.x;
  outcome.results["end_y_m"] = p_H0B_.y;
}

}  // namespace tether::tasks
