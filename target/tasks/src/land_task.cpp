#include "dead_reckoning.h"
#include "motion.h"

#include <algorithm>
#include <cmath>

#include <tether/tasks/mission_tasks.h>
#include <tether/tasks/task.h>

namespace tether::tasks {
namespace {

constexpr Duration kPeriod = std::chrono::milliseconds(500);
constexpr double kSlow = 0.5;  // of the speed
/// A smaller change of speed can be over before the IMU is read again.
constexpr double kLeastChange_m_s = 0.15;
/// Of the change of speed that was commanded: what a UAV that flies deviates from it at most.
constexpr double kDeviation = 0.7;

}  // namespace

LandTask::LandTask(const LandOptions& options)
    : options_(options), limit_(options.time_limit, options.max_readings) {}

LandTask::~LandTask() = default;

Progress LandTask::initialise(TaskContext& context) {
  limit_.start(context.vehicle().now());
  v_wanted_m_s_ = z_at_switch_m_ = 0.0;
  const auto imu = context.sensor(options_.imu, uav::SensorKind::kImu);
  if (!imu) return TaskOutcome::failed(imu.failure());
  if (const Status stopped = stop(context); !stopped) return TaskOutcome::failed(stopped.failure());
  reckoning_ = std::make_unique<DeadReckoning>((*imu)->X_BS.q);
  if (Progress end = calibrate(context, options_.imu, {options_.settle_time, options_.rest_time},
                               limit_, *reckoning_))
    return end;
  return sink(context, options_.speed_m_s);
}

Progress LandTask::sink(TaskContext& context, double speed_m_s) {
  change_wanted_m_s_ = -speed_m_s - v_wanted_m_s_;
  v_wanted_m_s_ = -speed_m_s;
  v_at_switch_m_s_ = reckoning_->velocity_m_s().z;
  z_at_switch_m_ = reckoning_->position_m().z;
  switched_at_ = reckoning_->read_at();
  const Status sinking = context.vehicle().command_velocity({{0, 0, v_wanted_m_s_}, 0.0});
  return sinking ? std::nullopt : Progress(TaskOutcome::failed(sinking.failure()));
}

Progress LandTask::step(TaskContext& context) {
  if (Progress end = limit_.next_round(context.vehicle().now())) return end;
  const Result<uav::ImuSample> reading = context.vehicle().read<uav::ImuSample>(options_.imu);
  if (!reading) return TaskOutcome::failed(reading.failure());
  reckoning_->update(*reading);
  if (reckoning_->read_at() - switched_at_ < kPeriod) return std::nullopt;
  const double changed_m_s = reckoning_->velocity_m_s().z - v_at_switch_m_s_;
  if (std::abs(changed_m_s / change_wanted_m_s_ - 1.0) > kDeviation)
    return TaskOutcome::goal_reached();
  const bool was_slow = v_wanted_m_s_ > -options_.speed_m_s;
  const double change_m_s = std::max(kSlow * options_.speed_m_s, kLeastChange_m_s);
  return sink(context, options_.speed_m_s - (was_slow ? 0.0 : change_m_s));
}

void LandTask::finalise(TaskContext& context, TaskOutcome& outcome) {
  fail_on(stop(context), outcome);
  outcome.results["duration_s"] = to_seconds(limit_.elapsed(context.vehicle().now()));
  outcome.results["descended_m"] = -z_at_switch_m_;
}

}  // namespace tether::tasks
