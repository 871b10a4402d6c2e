#pragma once

#include <tether/base/time.h>

namespace tether::coordinator {

/// A limit on the speed of ST relative to WT: the pace of a free-running simulation, or a simulator
/// that is slowed down. Unused time is lost beyond a small credit, as in other simulators: one that
/// was late does not catch up. Pure: the clock's readings are arguments. Not
/// thread-safe.
class RealTimeLimit {
 public:
  /// At most `factor` of ST per WT from `now` on, with at most `max_credit` of ST saved up. @pre
  /// factor > 0.
  RealTimeLimit(double factor, Duration max_credit, WallTime now);

  /// ST that may be simulated at `now`.
  Duration allowance(WallTime now);
  /// `spent` was simulated. @pre spent ≤ the last allowance.
  void spend(Duration spent) { credit_ -= spent; }
  /// Nothing was to be simulated until `now`: no credit for it.
  void idle(WallTime now);
  /// WT from the last `allowance` until `wanted` of ST is allowed.
  Duration wait_for(Duration wanted) const;

 private:
  double factor_;
  Duration max_credit_;
  Duration credit_{0};
  WallTime last_;
};

}  // namespace tether::coordinator
