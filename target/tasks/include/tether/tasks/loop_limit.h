#pragma once

#include <algorithm>

#include <tether/base/time.h>
#include <tether/tasks/task.h>

namespace tether::tasks {

/// Ends a task loop that does not end by itself: after a time on the SUT's clock, or after a number
/// of rounds in case that clock is stopped. Not thread-safe.
class LoopLimit {
 public:
  /// @pre time_limit > 0, max_rounds > 0
  LoopLimit(Duration time_limit, int max_rounds)
      : time_limit_(time_limit), max_rounds_(max_rounds) {}

  /// Call once, when the task begins.
  void start(ExecTime now);
  /// Call at the beginning of each round. Returns "time limit" or "round limit" at the end.
  Progress next_round(ExecTime now);
  /// Time since `start`.
  Duration elapsed(ExecTime now) const { return now - started_at_; }
  /// What is left of the time limit; never negative.
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
