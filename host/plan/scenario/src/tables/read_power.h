#pragma once

#include <tether/energy/meter.h>
#include <tether/toml/table.h>

namespace tether::scenario {

/// The keys `idle_w` and `busy_core_w` of a table.
energy::Computer read_power(const toml::Table& table);

}  // namespace tether::scenario
