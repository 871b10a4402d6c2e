#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tether/base/time.h>
#include <tether/toml/table.h>
#include <tether/uav/sensor_timing.h>

namespace tether::scenario {

/// A delay, such as the key 'delay' of a sensor's table; adds sample files to `files`.
uav::Delay read_delay(const toml::Table& table, const std::string& key,
                      std::vector<std::filesystem::path>& files);

/// Measured delays: one number per line, in units of `seconds_per_unit`; blank lines and
/// lines that start with '#' are skipped.
/// @throws Error(kBadFile) at a line that is not a number, negative or too large, or if there is no
///   number at all.
std::vector<Duration> read_delay_samples(const std::filesystem::path& file,
                                         double seconds_per_unit);

}  // namespace tether::scenario
