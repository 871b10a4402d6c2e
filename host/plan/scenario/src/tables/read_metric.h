#pragma once

#include <tether/scenario/scenario.h>
#include <tether/toml/table.h>

namespace tether::scenario {

/// Reads [[metric]]. @pre the scenario has its UAVs, anchors and limits
void read_metrics(const toml::Table& root, Scenario& scenario);

}  // namespace tether::scenario
