#pragma once

#include <tether/base/time.h>

namespace tether::sync {

/// The most that the clock behind a SUT's ET can advance in an interval of wall time: `rate` times
/// the interval, plus `slack`.
struct ClockBound {
  double rate;     ///< the most ET per second of wall time; > 0
  Duration slack;  ///< of ET, for an interval of any length; ≥ 0
};

/// A wall clock × `factor`. Slack: 1 ms × `factor`, for the resolution of the two clocks.
/// @pre factor > 0.
ClockBound wall_bound(double factor);

/// No machine has more cores; assumed if the number is unknown.
inline constexpr int kMostCores = 1024;

/// CPU time of a process and its descendants × `factor`, on a machine of `cores` cores (0:
/// unknown), which is the sum over all cores. Slack: the kernel accounts for the thread that reads
/// the clock up to that moment, for other threads up to the last tick of their core (100 to 1000
/// ticks a second). So time that other threads used before the SUT resumed may be charged
/// afterwards: up to 10 ms per core, and a second in all; and 20 ms of what a living child's
/// children used, which it counts in ticks. @pre factor > 0; 0 ≤ cores ≤ kMostCores.
ClockBound cpu_bound(double factor, int cores);

/// Clock plausibility: the upper bound on a SUT's ET by the coordinator's clock (DESIGN section 2,
/// rule 5). Since the SUT resumed, its clock cannot have advanced more than the coordinator's.
/// Delays of the link only add to the coordinator's time, so a correct clock is always accepted; of
/// a stamp that is ahead, the excess is known. Pure: the clock's readings are arguments. Not
/// thread-safe.
class ClockPlausibility {
 public:
  /// Relative drift between two correct clocks.
  static constexpr double kDrift = 1e-3;

  /// The SUT runs from `now` with ET = `start`.
  ClockPlausibility(ClockBound bound, ExecTime start, WallTime now)
      : bound_(bound), et_(start), wall_(now) {}

  /// It was stopped, and resumes at `now` with ET = `at`; at the time of the stop, if its children
  /// were not stopped.
  void go_on(ExecTime at, WallTime now);
  /// By how much `stamp`, received at `now`, exceeds the upper bound; 0 if it does not.
  /// @pre now ≥ every earlier `now`; 0 ≤ stamp < 2^62 ns.
  Duration excess(ExecTime stamp, WallTime now) const;
  /// ET at which it last resumed.
  ExecTime went_on_at() const { return et_; }

 private:
  ClockBound bound_;
  ExecTime et_;
  WallTime wall_;
};

}  // namespace tether::sync
