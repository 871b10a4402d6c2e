#pragma once

#include <vector>

#include <tether/scenario/scenario.h>
#include <tether/toml/table.h>

namespace tether::scenario {

/// Reads the tables [vary.NAME], in the order of their names.
std::vector<Variation> read_vary(const toml::Table& root);

}  // namespace tether::scenario
