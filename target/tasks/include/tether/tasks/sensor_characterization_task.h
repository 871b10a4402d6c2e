#pragma once

#include <cstdint>
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

/// One reading of a sensor and its times.
struct Acquisition {
  ExecTime asked_at;
  ExecTime had_at;          ///< ≥ asked_at; the difference is what Algorithm 1 measures
  SimTime sampled_at;       ///< timestamp of the sample
  std::uint64_t index = 0;  ///< of the sample
};

/// Algorithm 1: acquires one sensor's data repeatedly, waiting each time for a new measurement, and
/// measures the time on the SUT's clock. Sends no command.
///
/// Results: "duration_s" (ET of all acquisitions, which the listing returns), "acquisitions" (their
/// number), and of one acquisition "mean_s", "min_s", "median_s", "max_s" and, with two or more,
/// "stddev_s" (of a sample).
class SensorCharacterizationTask : public Task {
 public:
  /// `sensor`: the name of a sensor of any kind.
  explicit SensorCharacterizationTask(std::string sensor,
                                      const SensorCharacterizationOptions& options = {});

  std::string_view name() const override { return "sensor_characterization"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

  /// All acquisitions of the last run in their order, even if it failed.
  const std::vector<Acquisition>& acquisitions() const { return acquisitions_; }

 private:
  std::string sensor_;
  SensorCharacterizationOptions options_;
  LoopLimit limit_;

  // Of the current run.
  uav::SensorKind kind_ = uav::SensorKind::kCamera;
  std::vector<Acquisition> acquisitions_;
};

}  // namespace tether::tasks
