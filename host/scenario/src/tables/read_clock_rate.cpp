#include "tables/read_clock_rate.h"

namespace tether::scenario {

ClockRate read_clock_rate(const toml::Table& table, Clock clock) {
  constexpr toml::Range kFactor{.min = 1e-3, .max = 1e4};
  constexpr toml::Range kComputing_ms{.min = 1e-3, .max = 60'000.0};
  if (clock != Clock::kCpu && table.has("cpu_factor"))
    table.fail("cpu_factor",
               "scales CPU time, so it needs clock = \"cpu\". To scale the wall clock, set it in a "
               "target file.");
  if (clock != Clock::kScripted && table.has("computing_ms"))
    table.fail("computing_ms",
               "replaces the measured computing time, so it needs clock = \"scripted\".");
  ClockRate rate{.cpu_factor = table.number_or("cpu_factor", kFactor, 1.0)};
  if (clock == Clock::kScripted) rate.computing = table.duration("computing_ms", kComputing_ms);
  return rate;
}

}  // namespace tether::scenario
