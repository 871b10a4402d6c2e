#pragma once

#include <memory>
#include <string>

#include <tether/base/time.h>
#include <tether/tasks/loop_limit.h>
#include <tether/tasks/task.h>

namespace tether::tasks {

struct LandOptions {
  double speed_m_s = 0.3;  ///< of the descent, the larger of the two; ≥ 0.15
  std::string imu = "imu";
  /// Pause after the stop, by the IMU's timestamps, while the UAV comes to rest; ≥ 0.
  Duration settle_time = std::chrono::seconds(1);
  /// The pause after that, in which the IMU's bias is measured; ≥ 0.
  Duration rest_time = std::chrono::seconds(1);
  Duration time_limit = std::chrono::seconds(30);  ///< of the SUT's clock; then "time limit"
  int max_readings = 200'000;                      ///< in case that clock is stopped
};

/// Descends until it stands on something. An IMU measures the same at a constant speed as on the
/// floor, and can miss the impact between two readings. So the task switches every half second, by
/// the IMU's timestamps, between the speed of the descent and a slower one: it has landed when the
/// UAV does not follow. Results: "duration_s" (ET), "descended_m" (dead-reckoned, to the last
/// switch).
class LandTask : public Task {
 public:
  explicit LandTask(const LandOptions& options = {});
  ~LandTask() override;

  std::string_view name() const override { return "land"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  Progress sink(TaskContext& context, double speed_m_s);

  LandOptions options_;
  LoopLimit limit_;

  // Of the current run.
  std::unique_ptr<class DeadReckoning> reckoning_;
  double v_wanted_m_s_ = 0.0;  ///< upwards, as all of these
  double change_wanted_m_s_ = 0.0;
  double v_at_switch_m_s_ = 0.0;
  double z_at_switch_m_ = 0.0;
  SimTime switched_at_;
};

}  // namespace tether::tasks
