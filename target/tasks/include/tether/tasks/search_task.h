#pragma once

#include <optional>
#include <string>

#include <tether/base/time.h>
#include <tether/base/units.h>
#include <tether/tasks/loop_limit.h>
#include <tether/tasks/task.h>

namespace tether::tasks {

struct SearchOptions {
  double yaw_rate_rad_s = rad_from_deg(30.0);  ///< > 0
  bool clockwise = false;
  int frames = 2;  ///< in this number of consecutive images the anchor must be seen; ≥ 1
  Duration time_limit = std::chrono::seconds(30);  ///< of the SUT's clock; then "time limit"
  int max_images = 100'000;                        ///< in case that clock is stopped
};

/// Turns on the spot until the anchor is seen, and stops. Results: "duration_s" (ET), "images",
/// "bearing_rad" (in the last image, if it was seen).
class SearchTask : public Task {
 public:
  explicit SearchTask(std::string anchor, const SearchOptions& options = {});

  std::string_view name() const override { return "search"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  std::string anchor_;
  SearchOptions options_;
  LoopLimit limit_;

  // Of the current run.
  int images_ = 0;
  int seen_in_a_row_ = 0;
  std::optional<double> bearing_rad_;
};

}  // namespace tether::tasks
