#include "motion.h"
#include "pose_track.h"

#include <algorithm>
#include <cmath>

#include <tether/tasks/mission_tasks.h>
#include <tether/tasks/task.h>

namespace tether::tasks {
namespace {

/// As many readings of a fast IMU wait while an image is computed.
constexpr std::uint32_t kImuQueue = 256;
/// Share of the difference to the gate's place that each sighting corrects.
constexpr double kTrustInSight = 0.3;
/// Acceleration for each m/s of speed ahead that is missing.
constexpr double kAheadGain_per_s = 2.0;
/// A gate is passed when its middle is so far behind [m].
constexpr double kBehind_m = 0.1;

/// `v`, no longer than `most`.
uav::Vec3 limited(const uav::Vec3& v, double most) {
  const double length = norm(v);
  return length <= most ? v : (most / length) * v;
}

/// The way from the camera to the middle of a gate, in the optical frame. The camera rolls with the
/// UAV: the upright rectangle around the gate is wider and higher than the gate.
uav::Vec3 way_to_middle(const uav::CameraModel& model, const uav::Anchor& gate,
                        const vision::Roi& roi, double roll_rad) {
  const double growth = std::cos(roll_rad) + std::abs(std::sin(roll_rad));
  const double pixels_per_m =
      (roi.width_px + roi.height_px) / ((gate.size_m.y + gate.size_m.z) * growth);
  return (model.fx_px / pixels_per_m + 0.5 * gate.size_m.x) * model.unproject(roi.center);
}

/// Of its y, above the horizon.
double roll_rad(const uav::Quat& q_W) {
  return std::asin(std::clamp(rotate(q_W, uav::Vec3{0.0, 1.0, 0.0}).z, -1.0, 1.0));
}

}  // namespace

FlyThroughGatesTask::FlyThroughGatesTask(const FlyThroughGatesOptions& options)
    : options_(options), limit_(options.time_limit, options.max_images) {}

FlyThroughGatesTask::~FlyThroughGatesTask() = default;

const uav::Anchor& FlyThroughGatesTask::gate(TaskContext& context) const {
  return context.vehicle().catalogue().anchors[passed_];
}

Progress FlyThroughGatesTask::initialise(TaskContext& context) {
  limit_.start(context.vehicle().now());
  passed_ = 0;
  images_ = sightings_ = 0;
  p_H0G_.reset();
  aim_H0_ = {};
  if (context.vehicle().catalogue().anchors.empty())
    return TaskOutcome::failed({Failure::Kind::kInvalid, "the scenario has no anchors to fly to"});
  VisionOptions vision = context.vision();
  vision.tracker.is_hollow = true;
  context.look_with(vision);
  const auto imu = context.sensor(options_.imu, uav::SensorKind::kImu);
  if (!imu) return TaskOutcome::failed(imu.failure());
  if (const Status queue = context.vehicle().set_queue(options_.imu, kImuQueue); !queue)
    return TaskOutcome::failed(queue.failure());
  track_ = std::make_unique<PoseTrack>((*imu)->X_BS.q);
  const auto start = context.vehicle().read<uav::OdometrySample>(options_.odometry);
  if (!start) return TaskOutcome::failed(start.failure());
  track_->update(*start);
  X_WH0_ = {start->p_WS, uav::from_axis_angle({0, 0, 1}, uav::yaw_rad(start->q_WS))};
  return std::nullopt;
}

Progress FlyThroughGatesTask::step(TaskContext& context) {
  if (Progress end = limit_.next_round(context.vehicle().now())) return end;
  if (const Status seen = look(context); !seen) return TaskOutcome::failed(seen.failure());
  const uav::Vec3 p_H0B = transform(inverse(X_WH0_), track_->now().p_WB);
  context.note_odometry(p_H0B, uav::yaw_rad(inverse(X_WH0_.q) * track_->now().q_WB));
  if (p_H0G_ && p_H0B.x > p_H0G_->x + kBehind_m) {
    const bool is_last = passed_ + 1 == context.vehicle().catalogue().anchors.size();
    if (is_last && p_H0B.x > p_H0G_->x + options_.run_out_m) {
      ++passed_;
      return TaskOutcome::goal_reached();
    }
    if (!is_last) {
      context.note_event(name(), "loop", "gate", {{"passed", static_cast<double>(++passed_)}});
      aim_H0_ = *p_H0G_;
      p_H0G_.reset();
    }
  }
  const Status steering = steer(context);
  return steering ? std::nullopt : Progress(TaskOutcome::failed(steering.failure()));
}

/// The next image, and what has happened until it was computed.
Status FlyThroughGatesTask::look(TaskContext& context) {
  const Result<Shot> shot = take_shot(context, gate(context).name);
  if (!shot) return shot.failure();
  ++images_;
  const std::optional<vision::Roi> roi = track(context, *shot);
  if (const Status followed = follow_motion(context); !followed) return followed;
  if (roi) see(context, *roi, shot->image.index, shot->image.sampled_at);
  return ok_status();
}

Status FlyThroughGatesTask::follow_motion(TaskContext& context) {
  const auto readings = client::read_all<uav::ImuSample>(context.vehicle(), options_.imu);
  if (!readings) return readings.failure();
  for (const uav::ImuSample& reading : *readings) track_->update(reading);
  const auto odometry =
      context.vehicle().read<uav::OdometrySample>(options_.odometry, client::Read::kIfAvailable);
  if (odometry) track_->update(*odometry);
  const bool is_good = odometry || odometry.failure().kind == Failure::Kind::kNothingYet;
  return is_good ? ok_status() : Status(odometry.failure());
}

/// A gate that is cut off has no distance, and its middle is not that of the ROI.
void FlyThroughGatesTask::see(TaskContext& context, const vision::Roi& roi,
                              std::uint64_t image_index, SimTime sampled_at) {
  const uav::SensorDescription& camera = **context.camera();
  if (roi.cut_above_or_below || roi.cut_left_or_right) return;
  const PoseTrack::State& then = track_->at(sampled_at);
  const uav::Quat q_WS = then.q_WB * camera.X_BS.q;
  const auto& model = std::get<uav::CameraProperties>(camera.properties).model;
  const uav::Vec3 way_W = rotate(q_WS * uav::q_body_from_optical(),
                                 way_to_middle(model, gate(context), roi, roll_rad(q_WS)));
  const uav::Vec3 way_B = rotate(inverse(then.q_WB), way_W);
  context.note_estimate(gate(context).name, image_index,
                        {std::atan2(way_B.y, way_B.x), std::hypot(way_W.x, way_W.y)}, true);
  const uav::Vec3 seen_H0 =
      transform(inverse(X_WH0_), then.p_WB + rotate(then.q_WB, camera.X_BS.p) + way_W);
  ++sightings_;
  p_H0G_ = p_H0G_ ? *p_H0G_ + kTrustInSight * (seen_H0 - *p_H0G_) : seen_H0;
}

/// Sideways and up a spring and a damper towards the middle of the gate; ahead at constant speed.
Status FlyThroughGatesTask::steer(TaskContext& context) {
  const PoseTrack::State& state = track_->now();
  const uav::Quat q_H0W = inverse(X_WH0_.q);
  const uav::Vec3 aside_H0 = p_H0G_.value_or(aim_H0_) - transform(inverse(X_WH0_), state.p_WB);
  const uav::Vec3 v_H0 = rotate(q_H0W, state.v_WB_m_s);
  const uav::Vec3 across =
      limited(options_.stiffness_per_s2 * uav::Vec3{0.0, aside_H0.y, aside_H0.z} -
                  options_.damping_per_s * uav::Vec3{0.0, v_H0.y, v_H0.z},
              options_.max_acceleration_m_s2);
  const double ahead_m_s2 =
      std::clamp(kAheadGain_per_s * (options_.speed_m_s - v_H0.x), -options_.max_acceleration_m_s2,
                 options_.max_acceleration_m_s2);
  uav::Setpoint setpoint;
  setpoint.mask = uav::kAcceleration | uav::kYaw;
  setpoint.in_heading = false;
  setpoint.acceleration_m_s2 = rotate(X_WH0_.q, uav::Vec3{ahead_m_s2, across.y, across.z});
  setpoint.yaw_rad = uav::yaw_rad(X_WH0_.q);
  return context.vehicle().command(setpoint);
}

void FlyThroughGatesTask::finalise(TaskContext& context, TaskOutcome& outcome) {
  fail_on(stop(context), outcome);
  outcome.results["duration_s"] = to_seconds(limit_.elapsed(context.vehicle().now()));
  outcome.results["images"] = images_;
  outcome.results["sightings"] = sightings_;
  outcome.results["gates"] = static_cast<double>(passed_);
}

}  // namespace tether::tasks
