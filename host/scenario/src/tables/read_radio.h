#pragma once

#include <tether/radio/settings.h>
#include <tether/toml/table.h>

namespace tether::scenario {

/// [radio] of a scenario, or of a condition; without it, the ideal radio.
/// @throws Error(kBadFile) with file and line, about the key.
radio::Settings read_radio(const toml::Table& parent);

}  // namespace tether::scenario
