#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <tether/scenario/scenario.h>
#include <tether/toml/table.h>

namespace tether::scenario {

/// Replaces the value in the file of a scenario, or adds it if the file lacks a key that it may
/// have. @return false if there is no such key.
bool apply(const Setting& setting, toml::Document& scenario);
/// Keeps as many UAVs as `count` says, the first ones of the file, with the metrics and computers
/// that are theirs. @throws Error(kUsage), about kUavCount, if there are not so many.
void keep_first_uavs(Scenario& scenario, const std::string& count);
/// Reads a profile, and replaces the values that it has; adds their keys to `replaced`.
Profile load_profile(const std::filesystem::path& file, const std::vector<Setting>& settings,
                     std::set<std::string>& replaced);
/// Replaces the values of sensors in the profiles of the scenario's UAVs and conditions.
/// @throws Error(kUsage), about the key, if none has it.
void apply_to_profiles(const std::vector<Setting>& settings, Scenario& scenario);

/// "-cpu_factor-2", of the last part of each key and its value (of a file, its stem).
std::string name_suffix(const std::vector<Setting>& settings);

}  // namespace tether::scenario
