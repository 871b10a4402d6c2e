#include "dead_reckoning.h"
#include "motion.h"

#include <tether/tasks/land_task.h>
#include <tether/tasks/task_context.h>

namespace tether::tasks {
namespace {

// Of the speed of the descent: more than the first is sinking, less than the second is standing.
constexpr double kSinking = 0.7;
constexpr double kStanding = 0.3;

}  // namespace

LandTask::LandTask(const LandOptions& options)
    : options_(options), limit_(options.time_limit, options.max_readings) {}

LandTask::~LandTask() = default;

Progress LandTask::initialise(TaskContext& context) {
  limit_.start(context.vehicle().now());
  is_sinking_ = false;
  const auto imu = context.sensor(options_.imu, uav::SensorKind::kImu);
  if (!imu) return TaskOutcome::failed(imu.failure());
  if (const Status stopped = stop(context); !stopped) return TaskOutcome::failed(stopped.failure());
  reckoning_ = std::make_unique<DeadReckoning>((*imu)->X_BS.q);
  if (Progress end = calibrate(context, options_.imu, options_.rest_time, limit_, *reckoning_))
    return end;
  const Status sinking = context.vehicle().command_velocity({{0, 0, -options_.speed_m_s}, 0.0});
  return sinking ? std::nullopt : Progress(TaskOutcome::failed(sinking.failure()));
}

Progress LandTask::step(TaskContext& context) {
  if (Progress end = limit_.next_round(context.vehicle().now())) return end;
  const Result<uav::ImuSample> reading = context.vehicle().read_imu(options_.imu);
  if (!reading) return TaskOutcome::failed(reading.failure());
  reckoning_->update(*reading);
  const double sinking_m_s = -reckoning_->velocity_m_s().z;
  is_sinking_ = is_sinking_ || sinking_m_s > kSinking * options_.speed_m_s;
  const bool has_landed = is_sinking_ && sinking_m_s < kStanding * options_.speed_m_s;
  return has_landed ? Progress(TaskOutcome::goal_reached()) : std::nullopt;
}

void LandTask::finalise(TaskContext& context, TaskOutcome& outcome) {
  fail_on(stop(context), outcome);
  outcome.results["duration_s"] = to_seconds(limit_.elapsed(context.vehicle().now()));
  if (reckoning_) outcome.results["descended_m"] = -reckoning_->position_m().z;
}

}  // namespace tether::tasks
