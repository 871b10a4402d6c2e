#pragma once

#include "interaction_clock.h"
#include "wall_timer.h"

#include <mutex>

#include <tether/client/sut_clock.h>

namespace tether::client {

/// Time in free running (DESIGN section 2, rule 8): the wall clock since the Welcome; nothing is
/// held. A virtual target slower than this machine is imitated by stalling: before each call, until
/// the slower machine would have done what was computed since the last one. Time for which the
/// program waited for a core of this machine is not added, unless it waited longer than that. The
/// clock shows the target's time from when the CPU time was used, not only from the stall on.
class FreeRunningClock final : public InteractionClock {
 public:
  /// @pre source.factor() ≥ 1. `source` and `wall` must outlive it.
  FreeRunningClock(const TimeSource& source, WallTimer& wall, ExecTime start);

  ExecTime now() const override;
  ExecTime begin() override;
  void end(ExecTime at) override;
  /// Stalling and sleeping count as computing: it is only the wait for the UAV's reply that does
  /// not.
  std::optional<ExecTime> while_computing() const override;

  /// Stalls as begin() does, then sleeps on the wall clock.
  void sleep_until(ExecTime until);

 private:
  enum class Phase { kComputing, kStalling, kCall, kSleeping };

  Duration wall_of_target() const;
  ExecTime et_at(Duration wall) const { return start_ + (wall - wall_at_start_); }
  void enter(Phase phase);

  const TimeSource* source_;
  WallTimer* wall_;
  ExecTime start_;
  Duration wall_at_start_;

  mutable std::mutex mutex_;  // not held while stalling or sleeping; guards what follows
  Phase phase_ = Phase::kComputing;
  Duration computing_since_;  // on the wall clock
  Duration accounted_;        // of the source, when the computing began
  Duration stall_until_{};    // on the wall clock, while stalling
};

}  // namespace tether::client
