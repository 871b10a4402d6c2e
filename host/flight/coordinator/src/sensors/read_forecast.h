#pragma once

#include "sensors/sensor_schedule.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <tether/base/time.h>

namespace tether::coordinator {

/// Forecasts which measurement of a periodic sensor its SUT will read next, from how long the SUT
/// has let pass before its last reads. Depends on timestamps only. A forecast is a hint for drawing
/// ahead; nothing else may depend on it.
///
/// Of all measurements that are read or forecast, at most one in ten is forecast in vain, whatever
/// the SUT does.
class ReadForecast {
 public:
  /// A read at `t` will be answered with measurement `index`.
  void requested(SimTime t, bool latest, std::uint64_t index);
  /// … and is answered at `t`.
  void replied(SimTime t) { replied_at_ = t; }
  /// The index that the next read gets after each of the last pauses. None if it would not be the
  /// same after all of them, if there were too few, if too many forecasts were wrong, or if it was
  /// forecast before.
  std::optional<std::uint64_t> next(const SensorSchedule& schedule);

 private:
  static constexpr std::size_t kPauses = 4;
  static constexpr std::size_t kReadsForEachWrong = 9;

  std::array<Duration, kPauses> pauses_{};  // from a reply to the next request; a ring
  std::size_t pauses_seen_ = 0;
  std::size_t reads_ = 0;
  std::size_t wrong_ = 0;                  // forecasts
  std::optional<std::uint64_t> expected_;  // the forecast of the next read
  std::optional<SimTime> replied_at_;      // none: a read is open, or there was none
  bool latest_ = false;
};

}  // namespace tether::coordinator
