#pragma once

#include <algorithm>

#include <tether/base/time.h>
#include <tether/tasks/task.h>

namespace tether::tasks {

/// Ends a task loop that does not end by itself: after a time of the SUT's clock, and, should that
/// clock stand still, after so many rounds. One thread.
class LoopLimit {
 public:
  /// @pre time_limit > 0, max_rounds > 0
  LoopLimit(Duration time_limit, int max_rounds)
      : time_limit_(time_limit), max_rounds_(max_rounds) {}

  /// Once, when the task begins.
  void start(ExecTime now);
  /// At the beginning of each round of the loop; says "time limit" or "round limit" when it is
  /// over.
  Progress next_round(ExecTime now);
  /// Since `start`.
  Duration elapsed(ExecTime now) const { return now - started_at_; }
  /// Of the time limit; never negative.
  Duration left(ExecTime now) const {
    return std::max(time_limit_ - elapsed(now), Duration::zero());
  }

 private:
  Duration time_limit_;
  int max_rounds_;
  ExecTime started_at_;
  int rounds_ = 0;
};

}  // namespace tether::tasks
