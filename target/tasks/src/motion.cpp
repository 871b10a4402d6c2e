#include "motion.h"

#include <cmath>

namespace tether::tasks {
namespace {

constexpr int kMostWithoutProgress = 1000;

}  // namespace

uav::Vec3 level(double direction_rad) {
  return {std::cos(direction_rad), std::sin(direction_rad), 0.0};
}

Status stop(TaskContext& context) {
  return context.vehicle().command_velocity({});
}

Status turn(TaskContext& context, double yaw_rate_rad_s) {
  return context.vehicle().command_velocity({{}, yaw_rate_rad_s});
}

Status turn_on_course(TaskContext& context, double yaw_rate_rad_s, const Course& course,
                      std::string_view imu) {
  const Result<double> yaw = get_yaw(context, imu);
  if (!yaw) return yaw.failure();
  return context.vehicle().command_velocity(
      {course.speed_m_s * level(course.yaw_rad - *yaw), yaw_rate_rad_s});
}

Status move_direction(TaskContext& context, double direction_rad, double speed_m_s) {
  return context.vehicle().command_velocity({speed_m_s * level(direction_rad), 0.0});
}

uav::Quat attitude(const uav::SensorDescription& imu, const uav::ImuSample& reading) {
  return reading.q_WS * inverse(imu.X_BS.q);
}

Result<double> get_yaw(TaskContext& context, std::string_view imu) {
  const auto sensor = context.sensor(imu, uav::SensorKind::kImu);
  if (!sensor) return sensor.failure();
  const Result<uav::ImuSample> reading =
      context.vehicle().read<uav::ImuSample>(imu, client::Read::kLatest);
  if (!reading) return reading.failure();
  return uav::yaw_rad(attitude(**sensor, *reading));
}

Status pause(TaskContext& context, const std::string& imu, Duration time) {
  Result<uav::ImuSample> reading =
      context.vehicle().read<uav::ImuSample>(imu, client::Read::kLatest);
  if (!reading) return reading.failure();
  const SimTime began_at = reading->sampled_at;
  SimTime latest = began_at;
  for (int without_progress = 0; latest - began_at < time; ++without_progress) {
    if (without_progress == kMostWithoutProgress) {
      return Failure{Failure::Kind::kInvalid,
                     "the readings of IMU \"" + imu + "\" are all from the same instant"};
    }
    reading = context.vehicle().read<uav::ImuSample>(imu);
    if (!reading) return reading.failure();
    if (reading->sampled_at > latest) {
      latest = reading->sampled_at;
      without_progress = -1;
    }
  }
  return ok_status();
}

Progress calibrate(TaskContext& context, const std::string& imu, const Rest& rest, LoopLimit& limit,
                   DeadReckoning& reckoning) {
  std::optional<SimTime> began_at;
  while (true) {
    if (Progress end = limit.next_round(context.vehicle().now())) return end;
    const Result<uav::ImuSample> reading = context.vehicle().read<uav::ImuSample>(imu);
    if (!reading) return TaskOutcome::failed(reading.failure());
    began_at = began_at.value_or(reading->sampled_at);
    const Duration rested = reading->sampled_at - *began_at;
    if (rested >= rest.settle_time + rest.measure_time) {
      reckoning.update(*reading);
      return std::nullopt;
    }
    if (rested >= rest.settle_time) reckoning.calibrate(*reading);
  }
}

Result<Shot> take_shot(TaskContext& context, const std::string& anchor) {
  const auto camera = context.camera();
  if (!camera) return camera.failure();
  const auto tracker = context.tracker(anchor);
  if (!tracker) return tracker.failure();
  Result<uav::CameraSample> image = context.capture((*camera)->name);
  if (!image) return image.failure();
  return Shot{**camera, **tracker, std::move(image).value()};
}

std::optional<vision::Roi> track(TaskContext& context, const Shot& shot) {
  const std::optional<vision::Roi> roi = context.detect(shot.tracker, shot.image);
  if (roi) context.note_roi(*roi, shot.image.index);
  return roi;
}

Result<std::optional<Sight>> look(TaskContext& context, const std::string& anchor_name) {
  const auto anchor = context.anchor(anchor_name);
  if (!anchor) return anchor.failure();
  const Result<Shot> shot = take_shot(context, anchor_name);
  if (!shot) return shot.failure();
  const std::optional<vision::Roi> roi = track(context, *shot);
  if (!roi) return std::optional<Sight>();
  const vision::RelativePosition position = vision::relative_position(shot->camera, **anchor, *roi);
  context.note_estimate(anchor_name, shot->image.index, position, true);
  return std::optional(Sight{shot->image.sampled_at, position});
}

void fail_on(const Status& status, TaskOutcome& outcome) {
  if (status || outcome.status == TaskStatus::kFailed) return;
  outcome.status = TaskStatus::kFailed;
  outcome.reason = status.failure().message;
  outcome.failure = status.failure().kind;
}

}  // namespace tether::tasks
