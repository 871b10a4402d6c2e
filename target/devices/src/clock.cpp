#include "clock.h"

#include <tether/os/machine.h>

namespace tether::devices {

Duration MonotonicClock::now() const {
  return os::read_clock(CLOCK_MONOTONIC);
}

void MonotonicClock::sleep_until(Duration instant) {
  os::sleep_until(instant);
}

}  // namespace tether::devices
