#pragma once

#include <deque>

#include <tether/base/time.h>

namespace tether::coordinator {

/// How many cores of a UAV's computer are busy, over time. What was before the last `mean_cores` is
/// forgotten.
class ComputerLoad {
 public:
  /// @pre not before what was added earlier.
  void add(SimTime from, SimTime to, double cores);
  /// One core is busy from `at` on, until `end`.
  void begin(SimTime at) { add(at, SimTime::max(), 1.0); }
  void end(SimTime at);

  /// On average between two times. @pre from < to, not before an earlier `from`.
  double mean_cores(SimTime from, SimTime to);
  /// The first boundary later than `st` at which it may change: up to there, it is the same in each
  /// step. SimTime::max(): it does not change.
  SimTime next_change(SimTime st, const StepGrid& grid) const;

 private:
  struct Use {
    SimTime from;
    SimTime to;
    double cores = 0.0;
  };
  std::deque<Use> uses_;  // in order, not overlapping
};

}  // namespace tether::coordinator
