#pragma once

#include <memory>
#include <string>

#include <tether/base/time.h>
#include <tether/tasks/loop_limit.h>
#include <tether/tasks/task.h>

namespace tether::tasks {

struct LandOptions {
  double speed_m_s = 0.3;  ///< of the descent; > 0
  std::string imu = "imu";
  /// Pause before the descent, by the IMU's timestamps, in which its bias is measured; ≥ 0.
  Duration rest_time = std::chrono::seconds(1);
  Duration time_limit = std::chrono::seconds(30);  ///< of the SUT's clock; then "time limit"
  int max_readings = 200'000;                      ///< in case that clock is stopped
};

/// Descends until the IMU shows that the descent has ended: it has gained the speed of the descent
/// once, and then has lost most of it. Results: "duration_s" (ET), "descended_m" (dead-reckoned).
class LandTask : public Task {
 public:
  explicit LandTask(const LandOptions& options = {});
  ~LandTask() override;

  std::string_view name() const override { return "land"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  LandOptions options_;
  LoopLimit limit_;

  // Of the current run.
  std::unique_ptr<class DeadReckoning> reckoning_;
  bool is_sinking_ = false;
};

}  // namespace tether::tasks
