#include "profile_file.h"

#include <toml++/toml.h>

namespace tether::system_test {

std::vector<double> samples_ms(const std::filesystem::path& profile, const std::string& sensor) {
  const toml::table file = toml::parse_file(profile.string());
  std::vector<double> samples;
  const auto* values = file["sensors"][sensor]["delay"]["samples_ms"].as_array();
  if (values == nullptr) return samples;
  for (const auto& value : *values) samples.push_back(value.value<double>().value());
  return samples;
}

std::string profile_name(const std::filesystem::path& profile) {
  return toml::parse_file(profile.string())["name"].value_or(std::string());
}

}  // namespace tether::system_test
