#pragma once

#include <ctime>
#include <string>

#include <tether/base/time.h>

namespace tether::os {

/// The reading of a clock of this machine: CLOCK_MONOTONIC, or the CPU time of a process or thread.
Duration read_clock(clockid_t clock);

/// The current time as in files: "2026-01-31T12:00:00Z".
std::string utc_now();

/// Sleeps until CLOCK_MONOTONIC reads that; returns at once if that is past.
void sleep_until(Duration monotonic);

}  // namespace tether::os
