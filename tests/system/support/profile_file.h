#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tether::system_test {

/// The measured delays that a profile has of a sensor [ms]; empty if there are none.
std::vector<double> samples_ms(const std::filesystem::path& profile, const std::string& sensor);
/// The profile's own name.
std::string profile_name(const std::filesystem::path& profile);

}  // namespace tether::system_test
