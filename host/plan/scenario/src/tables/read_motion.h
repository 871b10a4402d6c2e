#pragma once

#include <tether/scenario/scenario.h>
#include <tether/toml/table.h>

namespace tether::scenario {

/// Reads [wind] and [[moving]]: what the scenario says of the motion of air and models.
void read_motion(const toml::Table& root, Scenario& scenario);

}  // namespace tether::scenario
