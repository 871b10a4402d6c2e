#pragma once

#include <tether/base/time.h>

namespace tether {

/// The simulator's time grid: step boundaries k·dt, k ≥ 0. Times of samples are rounded down, times
/// of commands up (DESIGN section 2, rules 1 to 3), so that neither data nor a command moves across
/// its timestamp. An immutable value; thread-safe.
class StepGrid {
 public:
  /// @pre dt > 0.
  constexpr explicit StepGrid(Duration dt) : dt_(dt) {}

  constexpr Duration dt() const { return dt_; }
  /// The last step boundary ≤ t. @pre t ≥ 0.
  constexpr SimTime floor(SimTime t) const { return t - t.time_since_epoch() % dt_; }
  /// The first step boundary ≥ t. @pre 0 ≤ t ≤ SimTime::max() − dt.
  constexpr SimTime ceil(SimTime t) const { return floor(t + dt_ - Duration(1)); }
  constexpr bool contains(SimTime t) const {
    return t.time_since_epoch() % dt_ == Duration::zero();
  }

  friend constexpr bool operator==(const StepGrid&, const StepGrid&) = default;

 private:
  Duration dt_;
};

}  // namespace tether
