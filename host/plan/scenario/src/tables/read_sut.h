#pragma once

#include <optional>

#include <tether/scenario/scenario.h>
#include <tether/toml/table.h>

namespace tether::scenario {

/// The table [sut], for every UAV without one of its own. Adds the files that it names to the
/// scenario's; so does read_sut. @pre the scenario's file, anchors and time limit are read.
std::optional<Sut> read_default_sut(const toml::Table& root, Scenario& scenario);

/// The SUT of a UAV: its own table, over `fallback`.
Sut read_sut(const toml::Table& uav, const std::optional<Sut>& fallback, Scenario& scenario);

}  // namespace tether::scenario
