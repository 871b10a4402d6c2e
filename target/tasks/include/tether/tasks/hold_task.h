#pragma once

#include <string>
#include <utility>

#include <tether/base/time.h>
#include <tether/tasks/task.h>

namespace tether::tasks {

struct HoldOptions {
  Duration duration = std::chrono::seconds(5);  ///< by the IMU's timestamps; > 0
  std::string imu = "imu";
};

/// Hovers for a time. Results: "duration_s" (ET).
class HoldTask : public Task {
 public:
  explicit HoldTask(HoldOptions options = {}) : options_(std::move(options)) {}

  std::string_view name() const override { return "hold"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  HoldOptions options_;
  ExecTime started_at_;
};

}  // namespace tether::tasks
