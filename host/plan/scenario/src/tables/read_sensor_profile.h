#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include <tether/scenario/profile.h>
#include <tether/toml/table.h>

namespace tether::scenario {

enum class KindKey { kRequired, kOptional };

/// Reads the table of one sensor, `sensors.<name>`; adds sample files to `files`.
SensorProfile read_sensor_profile(const toml::Table& sensors, std::string_view name,
                                  KindKey kind_key, std::vector<std::filesystem::path>& files);

/// @throws Error(kBadFile) at and about the first key of `profile` that a sensor of that kind does
/// not support.
void require_kind(const SensorProfile& profile, std::string_view sensor, uav::SensorKind kind);

}  // namespace tether::scenario
