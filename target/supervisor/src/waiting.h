#pragma once

#include <chrono>

#include <time.h>

#include <tether/base/time.h>

namespace tether::supervisor {

/// Polls until `done` holds; false if it does not within `limit`. Sleeps in between, for increasing
/// times, because the process that it waits for can need this core.
template <class Done>
bool wait_until(Done done, Duration limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  long pause_ns = 5'000;
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    const timespec pause{0, pause_ns};
    ::nanosleep(&pause, nullptr);
    if (pause_ns < 1'000'000) pause_ns += pause_ns / 4;
  }
  return true;
}

}  // namespace tether::supervisor
