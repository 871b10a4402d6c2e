#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tether/scenario/scenario.h>
#include <tether/toml/table.h>

namespace tether::scenario {

/// @throws Error(kUsage), about the key, if the file does not have it.
void apply(const Setting& setting, toml::Document& document, const std::filesystem::path& file);

/// "-cpu_factor-2", of the last part of each key and its value (of a file, its stem).
std::string name_suffix(const std::vector<Setting>& settings);

}  // namespace tether::scenario
