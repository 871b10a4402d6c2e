#pragma once

#include "sensor_schedule.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <tether/base/time.h>

namespace tether::coordinator {

/// Forecasts which measurement of a periodic sensor its SUT will read next, from how long the SUT
/// has let pass before its last reads. Depends on timestamps only. A forecast is a hint for drawing
/// ahead; nothing else may depend on it.
class ReadForecast {
 public:
  /// A read at `t` will be answered with a measurement.
  void requested(SimTime t, bool latest);
  /// … and is answered at `t`.
  void replied(SimTime t) { replied_at_ = t; }
  /// The index that the next read gets after each of the last pauses. None if it would not be the
  /// same after all of them, or if there were too few.
  std::optional<std::uint64_t> next(const SensorSchedule& schedule) const;

 private:
  static constexpr std::size_t kPauses = 4;
  static constexpr std::size_t kFewestPauses = 2;

  std::array<Duration, kPauses> pauses_{};  // from a reply to the next request; a ring
  std::size_t count_ = 0;
  std::optional<SimTime> replied_at_;  // none: a read is open, or there was none
  bool latest_ = false;
};

}  // namespace tether::coordinator
