#pragma once

#include <tether/base/time.h>
#include <tether/scenario/clock.h>
#include <tether/toml/table.h>

namespace tether::scenario {

/// How fast the execution time of a clock advances.
struct ClockRate {
  double cpu_factor = 1.0;
  Duration computing{0};  ///< of Clock::kScripted, for each phase of computing
};

/// Reads `cpu_factor` and `computing_ms` beside a `clock`; rejects those that it does not use.
ClockRate read_clock_rate(const toml::Table& table, Clock clock);

}  // namespace tether::scenario
