#include "tables/read_clock.h"

#include <string_view>
#include <vector>

namespace tether::scenario {

computer::ClockKind read_clock_kind(const toml::Table& table,
                                    std::initializer_list<computer::ClockKind> allowed) {
  std::vector<std::string_view> names;
  for (const computer::ClockKind kind : allowed) names.push_back(computer::name(kind));
  return allowed.begin()[table.choice("clock", names)];
}

computer::Clock read_clock(const toml::Table& table,
                           std::initializer_list<computer::ClockKind> allowed) {
  constexpr toml::Range kFactor{.min = 1e-3, .max = 1e4};
  constexpr toml::Range kComputing_ms{.min = 1e-3, .max = 60'000.0};
  computer::Clock clock{.kind = read_clock_kind(table, allowed)};
  if (clock.kind != computer::ClockKind::kCpu && table.has("cpu_factor"))
    table.fail("cpu_factor",
               "scales CPU time, so it needs clock = \"cpu\". To scale the wall clock, set it in a "
               "target file.");
  if (clock.kind != computer::ClockKind::kScripted && table.has("computing_ms"))
    table.fail("computing_ms",
               "replaces the measured computing time, so it needs clock = \"scripted\".");
  clock.factor = table.number_or("cpu_factor", kFactor, 1.0);
  if (clock.kind == computer::ClockKind::kScripted)
    clock.computing = table.duration("computing_ms", kComputing_ms);
  return clock;
}

}  // namespace tether::scenario
