#pragma once

#include <ctime>

#include <tether/base/time.h>

namespace tether::os {

/// The reading of a clock of this machine: CLOCK_MONOTONIC, or the CPU time of a process or thread.
Duration read_clock(clockid_t clock);

/// Sleeps until CLOCK_MONOTONIC reads that; returns at once if that is past.
void sleep_until(Duration monotonic);

}  // namespace tether::os
