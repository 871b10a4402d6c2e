#pragma once

#include <optional>

#include <tether/scenario/scenario.h>
#include <tether/toml/table.h>

/// The computers of a scenario's fleet: [[target]], and who is on them.
namespace tether::scenario {

/// Reads [[target]] into the scenario.
void read_computers(const toml::Table& root, Scenario& scenario);

/// Reads on which of them the program of a UAV runs; none: it is not said.
std::optional<Seat> read_seat(const toml::Table& table, const Scenario& scenario);

/// Checks that each of them is named by a UAV. @throws Error(kBadFile)
void require_users(const Scenario& scenario);

/// Makes the SUTs of a condition without a clock or target of its own run on them.
void read_seats(const toml::Table& table, Condition& condition, const Scenario& scenario);

}  // namespace tether::scenario
