#include "motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <tether/tasks/mission_tasks.h>
#include <tether/tasks/task.h>

namespace tether::tasks {
namespace {

/// Integral gain as a share of the proportional one's square: damped well.
constexpr double kIntegralShare = 0.4;
/// It sinks while it is no farther beside the anchor than this, and this share of its height.
constexpr double kAlways_m = 0.15, kShareOfHeight = 0.2;
constexpr double kLeastDown = 0.05;  // of a ray's length
/// A rangefinder that is nearer to the ground than it can measure reads −inf.
constexpr double kStanding_m = 0.045;
/// Of the speed of the descent, at the end.
constexpr double kTouch = 0.6;
constexpr Duration kRest = std::chrono::seconds(1);

uav::Vec3 within(const uav::Vec3& v, double most) {
  const double length = norm(v);
  return length > most ? (most / length) * v : v;
}

}  // namespace

LandOnTask::LandOnTask(std::string anchor, const LandOnOptions& options)
    : anchor_(std::move(anchor)),
      options_(options),
      limit_(options.time_limit, options.max_images) {}

Progress LandOnTask::initialise(TaskContext& context) {
  seen_at_ = context.vehicle().now();
  limit_.start(seen_at_);
  images_ = 0;
  last_image_at_.reset();
  carried_H_m_s_ = {};
  offset_m_ = 0.0;
  stands_ = false;
  return std::nullopt;
}

Result<LandOnTask::View> LandOnTask::look_down(TaskContext& context) {
  client::Vehicle& vehicle = context.vehicle();
  const auto imu = context.sensor(options_.imu, uav::SensorKind::kImu);
  if (!imu) return imu.failure();
  const Result<Shot> shot = take_shot(context, anchor_);
  if (!shot) return shot.failure();
  const auto height = vehicle.read<uav::RangeSample>(options_.range, client::Read::kLatest);
  if (!height) return height.failure();
  const auto reading = vehicle.read<uav::ImuSample>(options_.imu, client::Read::kLatest);
  if (!reading) return reading.failure();
  View view{height->range_m, shot->image.sampled_at, std::nullopt};
  const std::optional<vision::Roi> roi = track(context, *shot);
  if (!roi) return view;
  const uav::SensorDescription& camera = shot->camera;
  const auto& lens = std::get<uav::CameraProperties>(camera.properties).model;
  const uav::Vec3 ray_B =
      rotate(camera.X_BS.q, rotate(uav::q_body_from_optical(), lens.unproject(roi->center)));
  const uav::Quat q_WB = attitude(**imu, *reading);
  const uav::Quat level = uav::from_axis_angle({0, 0, 1}, -uav::yaw_rad(q_WB)) * q_WB;
  const uav::Vec3 ray_H = rotate(level, ray_B);
  // Along the ground, or without a height, where the anchor is cannot be told.
  if (ray_H.z > -kLeastDown || !std::isfinite(view.height_m)) return view;
  const double scale = std::max(view.height_m, 0.0) / -ray_H.z;
  view.anchor_H_m = uav::Vec3{scale * ray_H.x, scale * ray_H.y, 0.0} +
                    uav::Vec3{camera.X_BS.p.x, camera.X_BS.p.y, 0.0};
  return view;
}

Progress LandOnTask::step(TaskContext& context) {
  if (Progress end = limit_.next_round(context.vehicle().now())) return end;
  const Result<View> view = look_down(context);
  if (!view) return TaskOutcome::failed(view.failure());
  ++images_;
  if (view->height_m < kStanding_m) return stand(context);
  if (view->height_m < options_.commit_height_m) return sink(context);
  return approach(context, *view);
}

Progress LandOnTask::approach(TaskContext& context, const View& view) {
  const Duration passed = view.sampled_at - last_image_at_.value_or(view.sampled_at);
  last_image_at_ = view.sampled_at;
  uav::Vec3 velocity_H = carried_H_m_s_;
  if (view.anchor_H_m) {
    seen_at_ = context.vehicle().now();
    offset_m_ = norm(*view.anchor_H_m);
    carried_H_m_s_ = within(carried_H_m_s_ + (kIntegralShare * options_.gain_per_s *
                                              options_.gain_per_s * to_seconds(passed)) *
                                                 *view.anchor_H_m,
                            options_.speed_m_s);
    velocity_H =
        within(carried_H_m_s_ + options_.gain_per_s * *view.anchor_H_m, options_.speed_m_s);
    const bool is_above = offset_m_ <= kAlways_m + kShareOfHeight * view.height_m;
    velocity_H.z = is_above ? -options_.descent_m_s : 0.0;
  } else if (context.vehicle().now() - seen_at_ > options_.lost_limit) {
    return TaskOutcome::not_reached("anchor lost");
  }
  const Status moving = context.vehicle().command_velocity({velocity_H, 0.0});
  return moving ? std::nullopt : Progress(TaskOutcome::failed(moving.failure()));
}

Progress LandOnTask::sink(TaskContext& context) {
  const uav::Vec3 velocity_H{carried_H_m_s_.x, carried_H_m_s_.y, -kTouch * options_.descent_m_s};
  const Status sinking = context.vehicle().command_velocity({velocity_H, 0.0});
  return sinking ? std::nullopt : Progress(TaskOutcome::failed(sinking.failure()));
}

Progress LandOnTask::stand(TaskContext& context) {
  uav::Setpoint off;
  off.mask = uav::kRotorSpeeds;
  off.rotor_speeds_rad_s.assign(context.vehicle().catalogue().limits.rotors, 0.0);
  if (const Status stopped = context.vehicle().command(off); !stopped)
    return TaskOutcome::failed(stopped.failure());
  stands_ = true;
  if (const Status rested = pause(context, options_.imu, kRest); !rested)
    return TaskOutcome::failed(rested.failure());
  return TaskOutcome::goal_reached();
}

void LandOnTask::finalise(TaskContext& context, TaskOutcome& outcome) {
  if (!stands_) fail_on(stop(context), outcome);
  outcome.results["duration_s"] = to_seconds(limit_.elapsed(context.vehicle().now()));
  outcome.results["images"] = images_;
  outcome.results["offset_m"] = offset_m_;
}

}  // namespace tether::tasks
