#pragma once

#include <tether/base/time.h>

namespace tether::sync {

/// How fast the clock behind a SUT's ET can go: in a stretch of wall time, by `rate` times that
/// much and `slack`.
struct ClockBound {
  double rate;     ///< the most ET per second of wall time; > 0
  Duration slack;  ///< of ET, whatever the stretch; ≥ 0
};

/// A wall clock × `factor`. Slack: two clocks are read to the millisecond at the worst, which the
/// factor stretches. @pre factor > 0.
ClockBound wall_bound(double factor);

/// No machine has more cores; what is taken of one of which nobody knows.
inline constexpr int kMostCores = 1024;

/// CPU time of a process × `factor`, on a machine of `cores` cores; 0: not known. It adds up what
/// runs on all of them at once. Slack: only the thread that reads the clock is accounted for up to
/// that moment, the others up to their core's last tick (100 to 1000 of them a second). So what
/// other threads computed before the SUT went on may be charged afterwards: up to a tick of 10 ms
/// per core, and a second in all. @pre factor > 0; 0 ≤ cores ≤ kMostCores.
ClockBound cpu_bound(double factor, int cores);

/// What a SUT's ET can be at most, by the coordinator's own clock (DESIGN section 2, rule 5): since
/// it was told to go on, no more of its clock can have gone by than of ours. The link only adds to
/// what we see go by, so a sound clock is never doubted; a stamp that is ahead shows with its size.
/// Pure: the clock's readings are arguments. Not thread-safe.
class ClockWitness {
 public:
  /// Two sound clocks may run apart by this share.
  static constexpr double kDrift = 1e-3;

  /// It goes on with ET = `start` at `now`.
  ClockWitness(ClockBound bound, ExecTime start, WallTime now)
      : bound_(bound), et_(start), wall_(now) {}

  /// It stood still, and goes on at `now` with ET = `at`.
  void go_on(ExecTime at, WallTime now);
  /// By how much `stamp`, heard at `now`, is ahead of all that can have gone by; 0 if it is not.
  /// @pre now ≥ every earlier argument; 0 ≤ stamp < 2^62 ns.
  Duration excess(ExecTime stamp, WallTime now) const;
  /// Where it last went on.
  ExecTime went_on_at() const { return et_; }

 private:
  ClockBound bound_;
  ExecTime et_;
  WallTime wall_;
};

}  // namespace tether::sync
