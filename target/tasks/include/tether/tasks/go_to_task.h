#pragma once

#include <memory>
#include <string>

#include <tether/base/time.h>
#include <tether/tasks/loop_limit.h>
#include <tether/tasks/task.h>
#include <tether/uav/math.h>

namespace tether::tasks {

struct GoToOptions {
  double ahead_m = 1.0;       ///< the goal, from the start: along the heading,
  double left_m = 0.0;        ///< to its left,
  double up_m = 0.0;          ///< and up
  double speed_m_s = 0.5;     ///< maximum; > 0
  double tolerance_m = 0.15;  ///< the goal is reached within this distance; > 0
  std::string imu = "imu";
  /// Pause after the stop, by the IMU's timestamps, while the UAV comes to rest; ≥ 0.
  Duration settle_time = std::chrono::seconds(1);
  /// The pause after that, in which the IMU's bias is measured; ≥ 0.
  Duration rest_time = std::chrono::seconds(1);
  Duration time_limit = std::chrono::seconds(60);  ///< of the SUT's clock; then "time limit"
  int max_readings = 200'000;                      ///< in case that clock is stopped
};

/// Stops, and then flies to a position relative to where it came to rest, by dead reckoning with
/// the IMU, at a constant heading. The height is that of the commands: thrust changes the vertical
/// speed faster than an IMU is read, which then shows what follows a change instead of the change.
/// Annotates its odometry. Results: "duration_s" (ET), "end_x_m",
/// "end_y_m", "end_z_m" (dead-reckoned, in the start-heading frame H0).
class GoToTask : public Task {
 public:
  explicit GoToTask(const GoToOptions& options = {});
  ~GoToTask() override;

  std::string_view name() const override { return "go_to"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  GoToOptions options_;
  LoopLimit limit_;

  // Of the current run.
  std::unique_ptr<class DeadReckoning> reckoning_;
  uav::Vec3 p_H0B_;
  double v_up_m_s_ = 0.0;  ///< of the last command
};

}  // namespace tether::tasks
