#include "dead_reckoning.h"
#include "motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <tether/tasks/paper_tasks.h>
#include <tether/tasks/task.h>

// Algorithm 5 as a state machine: a rest before the start, in which the IMU's bias is measured and
// the anchor located; four legs by dead reckoning; turning back to the start heading; a pause to
// come to rest; and a second look at the anchor, whose difference to the first one is the
// displacement.
namespace tether::tasks {
namespace {

constexpr int kLegs = 4;
/// Yaw rate for each radian that is left to turn; slow enough for readings at 20 Hz.
constexpr double kTurnGain_per_s = 2.0;

double direction_rad(int leg) {
  return 0.5 * std::numbers::pi * leg;
}

uav::Quat about_z(double yaw_rad) {
  return uav::from_axis_angle({0, 0, 1}, yaw_rad);
}

/// The anchor's place from the UAV, level and along its heading: the estimate's distance is the
/// camera's.
uav::Vec3 position_HA(const uav::SensorDescription& camera,
                      const vision::RelativePosition& estimate) {
  const uav::Vec3 mounting{camera.X_BS.p.x, camera.X_BS.p.y, 0.0};
  return mounting + estimate.distance_m.value_or(0.0) * level(estimate.bearing_rad);
}

}  // namespace

struct ClosedPathTask::Flight {
  DeadReckoning reckoning;
  Phase phase = Phase::kLegs;
  ExecTime phase_started_at;                ///< of the leg, in kLegs
  int leg = 0;                              ///< as many are flown to their end
  SimTime read_at;                          ///< the instant of the last reading
  SimTime stopped_at;                       ///< that of the last one before the stop
  uav::Vec3 leg_start_m;                    ///< in H0
  uav::Vec3 p_H0A;                          ///< the anchor, seen from the start
  std::optional<uav::Vec3> displacement_m;  ///< in H0
};

ClosedPathTask::ClosedPathTask(std::string anchor, const ClosedPathOptions& options)
    : options_(options),
      limit_(options.time_limit, options.max_readings),
      relative_position_(std::move(anchor), {options.convergence, options.time_limit}) {}

ClosedPathTask::~ClosedPathTask() = default;

Progress ClosedPathTask::initialise(TaskContext& context) {
  limit_.start(context.vehicle().now());
  flight_ = std::make_unique<Flight>();
  const auto imu = context.sensor(options_.imu, uav::SensorKind::kImu);
  if (!imu) return TaskOutcome::failed(imu.failure());
  flight_->reckoning = DeadReckoning((*imu)->X_BS.q);
  if (Progress end = see_anchor(context, "at the start", flight_->p_H0A)) return end;
  if (Progress end = rest(context)) return end;
  return start_leg(context);
}

/// Algorithm 2, as a place: what is not sure to be right is no basis for an estimate.
Progress ClosedPathTask::see_anchor(TaskContext& context, std::string_view when, uav::Vec3& p_HA) {
  TaskOutcome outcome = run(relative_position_, context);
  if (outcome.status == TaskStatus::kFailed) return outcome;
  if (!outcome.reached()) return TaskOutcome::not_reached(outcome.reason + " " + std::string(when));
  if (!relative_position_.estimate()->distance_m) {
    return TaskOutcome::not_reached("no distance to the anchor " + std::string(when));
  }
  const auto camera = context.camera();
  p_HA = position_HA(**camera, *relative_position_.estimate());
  return std::nullopt;
}

/// Reads the IMU before anything moves: its bias, and the start of dead reckoning.
Progress ClosedPathTask::rest(TaskContext& context) {
  std::optional<SimTime> began_at;
  while (true) {
    if (const Progress end = limit_.next_round(context.vehicle().now())) {
      return TaskOutcome::not_reached(end->reason + " at rest before the start");
    }
    const auto reading = context.vehicle().read<uav::ImuSample>(options_.imu);
    if (!reading) return TaskOutcome::failed(reading.failure());
    began_at = began_at.value_or(reading->sampled_at);
    if (reading->sampled_at - *began_at >= options_.rest_time) {
      reckon(context, *reading);
      return std::nullopt;
    }
    flight_->reckoning.calibrate(*reading);
  }
}

Progress ClosedPathTask::read_imu(TaskContext& context) {
  const auto reading = context.vehicle().read<uav::ImuSample>(options_.imu);
  if (!reading) return TaskOutcome::failed(reading.failure());
  reckon(context, *reading);
  return std::nullopt;
}

void ClosedPathTask::reckon(TaskContext& context, const uav::ImuSample& reading) {
  flight_->read_at = reading.sampled_at;
  flight_->reckoning.update(reading);
  context.note_odometry(flight_->reckoning.position_m(), flight_->reckoning.yaw_rad());
}

void ClosedPathTask::enter(TaskContext& context, Phase phase) {
  flight_->phase = phase;
  flight_->phase_started_at = context.vehicle().now();
}

Progress ClosedPathTask::start_leg(TaskContext& context) {
  enter(context, Phase::kLegs);
  flight_->leg_start_m = flight_->reckoning.position_m();
  const double direction = direction_rad(flight_->leg) - flight_->reckoning.yaw_rad();
  if (const Status moving = move_direction(context, direction, options_.speed_m_s); !moving) {
    return TaskOutcome::failed(moving.failure());
  }
  context.note_event(name(), "loop", "leg", {{"direction_rad", direction_rad(flight_->leg)}});
  return std::nullopt;
}

Progress ClosedPathTask::step(TaskContext& context) {
  if (const Progress end = limit_.next_round(context.vehicle().now())) {
    return TaskOutcome::not_reached(end->reason + " " + place());
  }
  switch (flight_->phase) {
    case Phase::kLegs:
      return follow_leg(context);
    case Phase::kTurnBack:
      return turn_back(context);
    case Phase::kSettle:
      break;
  }
  return settle(context);
}

std::string ClosedPathTask::place() const {
  switch (flight_->phase) {
    case Phase::kLegs:
      return "in leg " + std::to_string(flight_->leg + 1);
    case Phase::kTurnBack:
      return "turning back";
    case Phase::kSettle:
      break;
  }
  return "coming to rest";
}

Progress ClosedPathTask::follow_leg(TaskContext& context) {
  const Duration limit =
      options_.leg_slack + duration_from_seconds(5.0 * options_.distance_m / options_.speed_m_s);
  if (context.vehicle().now() - flight_->phase_started_at > limit) {
    return TaskOutcome::not_reached("time limit " + place());
  }
  if (Progress end = read_imu(context)) return end;
  const uav::Vec3 flown_m = flight_->reckoning.position_m() - flight_->leg_start_m;
  if (dot(flown_m, level(direction_rad(flight_->leg))) < options_.distance_m) return std::nullopt;
  if (++flight_->leg < kLegs) return start_leg(context);
  enter(context, Phase::kTurnBack);
  const Status stopped = stop(context);
  return stopped ? std::nullopt : Progress(TaskOutcome::failed(stopped.failure()));
}

Progress ClosedPathTask::turn_back(TaskContext& context) {
  if (context.vehicle().now() - flight_->phase_started_at > options_.turn_limit) {
    return TaskOutcome::not_reached("time limit " + place());
  }
  if (Progress end = read_imu(context)) return end;
  const double left_rad = -flight_->reckoning.yaw_rad();
  const bool is_back = std::abs(left_rad) <= options_.turn_tolerance_rad;
  const double rate =
      std::clamp(kTurnGain_per_s * left_rad, -options_.turn_rate_rad_s, options_.turn_rate_rad_s);
  const Status turning = turn(context, is_back ? 0.0 : rate);
  if (!turning) return TaskOutcome::failed(turning.failure());
  if (is_back) {
    flight_->stopped_at = flight_->read_at;
    enter(context, Phase::kSettle);
  }
  return std::nullopt;
}

Progress ClosedPathTask::settle(TaskContext& context) {
  if (flight_->read_at - flight_->stopped_at >= options_.settle_time) return measure(context);
  return read_imu(context);
}

/// Where the UAV is from its start, by where it saw the anchor from either.
Progress ClosedPathTask::measure(TaskContext& context) {
  uav::Vec3 p_HA;
  if (Progress end = see_anchor(context, "at the end", p_HA)) return end;
  flight_->displacement_m = flight_->p_H0A - rotate(about_z(flight_->reckoning.yaw_rad()), p_HA);
  context.note_displacement(*flight_->displacement_m);
  return TaskOutcome::goal_reached();
}

void ClosedPathTask::finalise(TaskContext& context, TaskOutcome& outcome) {
  fail_on(stop(context), outcome);
  outcome.results["duration_s"] = to_seconds(limit_.elapsed(context.vehicle().now()));
  outcome.results["legs"] = flight_->leg;
  outcome.results["path_length_m"] = flight_->reckoning.path_length_m();
  outcome.results["end_x_m"] = flight_->reckoning.position_m().x;
  outcome.results["end_y_m"] = flight_->reckoning.position_m().y;
  if (const auto& displacement = flight_->displacement_m) {
    outcome.results["displacement_m"] = norm(*displacement);
    outcome.results["displacement_x_m"] = displacement->x;
    outcome.results["displacement_y_m"] = displacement->y;
  }
}

}  // namespace tether::tasks
