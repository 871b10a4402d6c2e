#pragma once

#include "interaction_clock.h"
#include "wall_timer.h"

#include <tether/client/sut_clock.h>

namespace tether::client {

/// Time in free running (DESIGN section 2, rule 8): the wall clock since the Welcome; nothing is
/// held. A virtual target slower than this machine is imitated by stalling: before each call, for
/// the time that the slower machine would have needed longer for the CPU time used since the last
/// one. Not thread-safe.
class FreeRunningClock final : public InteractionClock {
 public:
  /// @pre source.factor() ≥ 1. `source` and `wall` must outlive it.
  FreeRunningClock(const TimeSource& source, WallTimer& wall, ExecTime start);

  ExecTime now() const override;
  ExecTime begin() override;
  void end(ExecTime at) override;
  std::optional<ExecTime> while_computing() const override { return std::nullopt; }

  /// Stalls as begin() does, then sleeps on the wall clock.
  void sleep_until(ExecTime until);

 private:
  const TimeSource* source_;
  WallTimer* wall_;
  ExecTime start_;
  Duration wall_at_start_;
  Duration accounted_;  // of the source: a stall was made for it, or it was no time of the SUT
};

}  // namespace tether::client
