#include "clock.h"

#include <cerrno>

#include <time.h>

namespace tether::devices {

Duration MonotonicClock::now() const {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return std::chrono::seconds(t.tv_sec) + Duration(t.tv_nsec);
}

void MonotonicClock::sleep_until(Duration instant) {
  if (instant <= now()) return;
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(instant);
  timespec until{};
  until.tv_sec = whole.count();
  until.tv_nsec = (instant - whole).count();
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace tether::devices
