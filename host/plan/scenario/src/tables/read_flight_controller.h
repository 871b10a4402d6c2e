#pragma once

#include <optional>

#include <tether/scenario/scenario.h>
#include <tether/toml/table.h>

namespace tether::scenario {

/// Reads a UAV's 'flight_controller': a name, or a table with its settings. None: it has none.
std::optional<FlightController> read_flight_controller(const toml::Table& uav);

}  // namespace tether::scenario
