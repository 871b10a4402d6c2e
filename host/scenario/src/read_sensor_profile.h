#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include <tether/scenario/profile.h>
#include <tether/toml/table.h>

namespace tether::scenario {

enum class KindKey { kRequired, kOptional };

/// Reads the table of one sensor, `sensors.<name>`; names of sample files are added to `files`.
SensorProfile read_sensor_profile(const toml::Table& sensors, std::string_view name,
                                  KindKey kind_key, std::vector<std::filesystem::path>& files);

/// @throws Error(kBadFile) at the first key of `profile` that means nothing to a sensor of that
/// kind.
void require_kind(const SensorProfile& profile, std::string_view sensor, uav::SensorKind kind);

}  // namespace tether::scenario
