#pragma once

#include <optional>
#include <string>

#include <tether/base/time.h>
#include <tether/base/units.h>
#include <tether/tasks/loop_limit.h>
#include <tether/tasks/task.h>

namespace tether::tasks {

struct InspectOptions {
  double distance_m = 1.5;                           ///< wanted, from the camera; > 0
  Duration duration = std::chrono::seconds(5);       ///< by the images' timestamps; > 0
  double distance_tolerance_m = 0.25;                ///< > 0
  double bearing_tolerance_rad = rad_from_deg(6.0);  ///< > 0
  double speed_m_s = 0.5;                            ///< maximum; > 0
  double yaw_rate_rad_s = rad_from_deg(40.0);        ///< maximum; > 0
  double yaw_gain_per_s = 1.5;                       ///< yaw rate for each radian; > 0
  double speed_gain_per_s = 0.8;                     ///< speed for each metre; > 0
  Duration lost_limit = std::chrono::seconds(3);     ///< without seeing the anchor; "anchor lost"
  Duration time_limit = std::chrono::seconds(60);    ///< of the SUT's clock; then "time limit"
  int max_images = 100'000;                          ///< in case that clock is stopped
  double least_charge = 0.0;  ///< share of the battery's; below it, "battery low"; 0: not read
};

/// Keeps the anchor straight ahead at a distance, until it was within the tolerances of both for a
/// time without a break. Each image leads to one command, in proportion to what it shows, so that a
/// slow computer makes the UAV swing. The anchor may move. Without the anchor in sight, it hovers.
///
/// Results: "duration_s" (ET), "images", "held_s" (the longest time within the tolerances),
/// "bearing_rad" and "distance_m" (the last ones).
class InspectTask : public Task {
 public:
  explicit InspectTask(std::string anchor, const InspectOptions& options = {});

  std::string_view name() const override { return "inspect"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  std::string anchor_;
  InspectOptions options_;
  LoopLimit limit_;

  // Of the current run.
  int images_ = 0;
  ExecTime seen_at_;
  std::optional<SimTime> held_since_;
  Duration held_{0};
  std::optional<double> bearing_rad_, distance_m_;
};

}  // namespace tether::tasks
