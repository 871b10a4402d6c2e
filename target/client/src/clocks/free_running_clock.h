#pragma once

#include "clocks/interaction_clock.h"
#include "clocks/wall_timer.h"

#include <mutex>

#include <tether/client/sut_clock.h>

namespace tether::client {

/// Time in free running (DESIGN section 2, rule 8): the ST of the last reply, and from there on the
/// wall clock at the real-time factor to which ST is limited. If ST is behind that, this clock
/// stands still until ST has caught up. Nothing is held. A virtual target slower than this machine
/// is imitated by stalling: before each call, until the slower machine would have done what was
/// computed since the last one. Time for which the program waited for a core of this machine is not
/// added, unless it waited longer than that. The clock shows the target's time from when the CPU
/// time was used, not only from the stall on.
class FreeRunningClock final : public InteractionClock {
 public:
  /// @pre the source's factor is ≥ 1, real_time_factor > 0. `source` and `wall` must outlive it.
  FreeRunningClock(const TimeSource& source, WallTimer& wall, ExecTime start,
                   double real_time_factor);

  ExecTime now() const override;
  ExecTime begin() override;
  void end(ExecTime at) override;
  /// Stalling counts as computing: it is only the wait for the UAV's reply that does not.
  std::optional<ExecTime> while_computing() const override;

 private:
  enum class Phase { kComputing, kStalling, kCall };

  Duration wall_of_target() const;
  ExecTime read() const;

  const TimeSource* source_;
  WallTimer* wall_;
  double real_time_factor_;

  mutable std::mutex mutex_;  // not held while stalling; guards what follows
  ExecTime st_at_reply_;      // the Welcome's, before the first one
  Duration wall_at_reply_;    // then
  mutable ExecTime latest_;   // that this clock has shown
  ExecTime stamp_;            // of the call that waits
  Phase phase_ = Phase::kComputing;
  Duration computing_since_;  // on the wall clock
  Duration accounted_;        // of the source, when the computing began
  Duration stall_until_{};    // on the wall clock, while stalling
};

}  // namespace tether::client
