#pragma once

#include <initializer_list>

#include <tether/computer/clock.h>
#include <tether/toml/table.h>

namespace tether::scenario {

/// Reads `clock`, which must be one of these.
computer::ClockKind read_clock_kind(const toml::Table& table,
                                    std::initializer_list<computer::ClockKind> allowed);

/// Reads `clock`, which must be of one of these kinds, with `cpu_factor` and `computing_ms`;
/// rejects those of the two that it does not use.
computer::Clock read_clock(const toml::Table& table,
                           std::initializer_list<computer::ClockKind> allowed);

}  // namespace tether::scenario
