#pragma once

#include <optional>
#include <string>

#include <tether/base/time.h>
#include <tether/base/units.h>
#include <tether/tasks/go_to_task.h>
#include <tether/tasks/loop_limit.h>
#include <tether/tasks/search_task.h>
#include <tether/tasks/task.h>

namespace tether::tasks {

struct SearchPairOptions {
  SearchOptions search{};  ///< its time limit is that of the whole
  /// Where the other UAV hovers: from the start, along the heading at the start, and to its left.
  double partner_ahead_m = 1.0;
  double partner_left_m = 0.0;
  double gap_m = 1.0;      ///< kept to the other one; > 0
  double speed_m_s = 0.5;  ///< maximum; > 0
  std::string imu = "imu";
  Duration repeat = std::chrono::milliseconds(500);  ///< between two messages; > 0
};

/// Two UAVs search for an anchor together (each runs this task): both turn on the spot until one
/// sees it. That one stops, and says so to the other by radio, again and again. The other one then
/// flies to it, and says that it is there. Both have then reached the goal.
///
/// Results: "duration_s" (ET), "images", "found" (1: saw the anchor itself), "sent" (messages).
class SearchPairTask : public Task {
 public:
  explicit SearchPairTask(std::string anchor, const SearchPairOptions& options = {});

  std::string_view name() const override { return "search_pair"; }
  Progress initialise(TaskContext& context) override;
  Progress step(TaskContext& context) override;
  void finalise(TaskContext& context, TaskOutcome& outcome) override;

 private:
  enum class Word { kFound, kHere };
  /// What the other one has said since the last call; waits for it until `timeout`.
  Result<std::optional<Word>> listen(TaskContext& context, Duration timeout);
  Status say(TaskContext& context, Word word);
  Progress search(TaskContext& context);
  Progress call(TaskContext& context);
  Progress come(TaskContext& context);

  std::string anchor_;
  SearchPairOptions options_;
  LoopLimit limit_;

  // Of the current run.
  double start_yaw_rad_ = 0.0;
  int images_ = 0;
  int seen_in_a_row_ = 0;
  int sent_ = 0;
  bool found_ = false;
};

}  // namespace tether::tasks
