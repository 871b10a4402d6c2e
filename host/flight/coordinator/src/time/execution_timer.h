#pragma once

#include <tether/base/time.h>

namespace tether::coordinator {

/// ET of a SUT that does not stamp its requests, as in the paper (Section II): a timer on the
/// coordinator's clock, paused while the SUT is held. It charges link time to the SUT, so records
/// call such SUTs "unstamped". Pure: the clock's readings are arguments. Not
/// thread-safe.
class ExecutionTimer {
 public:
  /// Running, with ET = `start` at wall time `now`.
  ExecutionTimer(ExecTime start, WallTime now) : base_et_(start), base_wall_(now) {}

  /// ET at `now`. @pre now ≥ every earlier argument.
  ExecTime read(WallTime now) const { return held_ ? base_et_ : base_et_ + (now - base_wall_); }
  /// The SUT is held from `now` on; returns its ET.
  ExecTime pause(WallTime now);
  /// It resumes at `now` with ET = `at`.
  void resume(WallTime now, ExecTime at);

 private:
  ExecTime base_et_;
  WallTime base_wall_;
  bool held_ = false;
};

}  // namespace tether::coordinator
