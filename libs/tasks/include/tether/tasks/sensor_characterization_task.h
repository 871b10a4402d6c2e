#pragma once

#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/tasks/loop_limit.h>
#include <tether/tasks/task.h>
#include <tether/uav/catalogue.h>

namespace tether::tasks {

struct SensorCharacterizationOptions {
  int acquisitions = 100;                          ///< > 0
  Duration time_limit = std::chrono::seconds(60);  ///< of the SUT's clock; then "time limit"
};

/// Algorithm 1: acquires one sensor's data again and again, each time waiting for what was not read
/// yet, and times it on the SUT's own clock. Moves nothing.
///
/// Results: "duration_s" (ET, of all acquisitions: what the listing returns), "acquisitions"
/// (made), and of one acquisition "mean_s", "min_s", "median_s", "max_s" and, from two on,
/// "stddev_s" (of a sample).
class SensorCharacterizationTask : public Task {
 public:
  /// `sensor`: any of the UAV's, whatever its kind.
  explicit SensorCharacterizationTask(std::string sensor,
                                      const SensorCharacterizationOptions& options = {});

  std::string_view name() const override { return "sensor_characterization"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  std::string sensor_;
  SensorCharacterizationOptions options_;
  LoopLimit limit_;

  // Of the current run.
  uav::SensorKind kind_ = uav::SensorKind::kCamera;
  std::vector<double> taken_s_;  ///< each acquisition
};

}  // namespace tether::tasks
