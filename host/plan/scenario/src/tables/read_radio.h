#pragma once

#include <filesystem>
#include <vector>

#include <tether/radio/settings.h>
#include <tether/toml/table.h>

namespace tether::scenario {

/// [radio] of a scenario, or of a condition; without it, the ideal radio. Adds files of delays to
/// `files`.
/// @throws Error(kBadFile) with file and line, about the key.
radio::Settings read_radio(const toml::Table& parent, std::vector<std::filesystem::path>& files);

}  // namespace tether::scenario
