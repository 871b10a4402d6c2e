#pragma once

#include <chrono>

#include <time.h>

#include <tether/base/time.h>

namespace tether::supervisor {

/// Asks again and again until `done` holds; false: it did not within `limit`. Sleeps in between,
/// since whoever is waited for may need this very core, and longer as time goes on.
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
