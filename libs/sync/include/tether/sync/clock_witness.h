#pragma once

#include <tether/base/time.h>

namespace tether::sync {

/// What a SUT's ET can be at most, by the coordinator's own clock (DESIGN section 2, rule 5): since
/// it was told to go on, no more of its clock can have gone by than of ours. The link only adds to
/// what we see go by, so a sound clock is never doubted; a stamp that is ahead shows with its size.
/// Pure: the clock's readings are arguments. Not thread-safe.
class ClockWitness {
 public:
  /// Two sound clocks may run apart by this share …
  static constexpr double kDrift = 1e-3;
  /// … and this much beside it.
  static constexpr Duration kJitter = std::chrono::milliseconds(1);

  /// It goes on with ET = `start` at `now`. `rate`: the most ET per second of wall time; > 0.
  ClockWitness(double rate, ExecTime start, WallTime now) : rate_(rate), et_(start), wall_(now) {}

  /// It stood still, and goes on at `now` with ET = `at`.
  void go_on(ExecTime at, WallTime now);
  /// By how much `stamp`, heard at `now`, is ahead of all that can have gone by; 0 if it is not.
  /// @pre now ≥ every earlier argument; 0 ≤ stamp < 2^62 ns.
  Duration excess(ExecTime stamp, WallTime now) const;
  /// Where it last went on.
  ExecTime went_on_at() const { return et_; }

 private:
  double rate_;
  ExecTime et_;
  WallTime wall_;
};

}  // namespace tether::sync
