#include "settings.h"

#include <fmt/format.h>

#include <tether/base/error.h>

namespace tether::scenario {

Setting parse_setting(std::string_view text, const std::filesystem::path& folder) {
  const std::size_t sign = text.find('=');
  if (sign == 0 || sign == std::string_view::npos || sign + 1 == text.size())
    throw Error(ErrorCode::kUsage,
                fmt::format("'{}' must be KEY=VALUE, for instance time_limit_s=30", text))
        .about(std::string(text));
  Setting setting{std::string(text.substr(0, sign)), std::string(text.substr(sign + 1))};
  std::error_code ignored;
  const std::filesystem::path file = folder / setting.value;
  if (std::filesystem::is_regular_file(file, ignored))
    setting.value = std::filesystem::absolute(file).lexically_normal().string();
  return setting;
}

bool apply(const Setting& setting, toml::Document& scenario) {
  for (const char* from : {"", "condition.", "uav.", "target."})
    if (scenario.replace(from + setting.key, setting.value) > 0) return true;
  return false;
}

void apply_to_profiles(const std::vector<Setting>& settings, Scenario& scenario) {
  if (settings.empty()) return;
  std::set<std::string> replaced;
  const auto reload = [&](Profile& profile) {
    profile = load_profile(profile.file, settings, replaced);
  };
  for (UavSetup& uav : scenario.uavs)
    if (uav.profile) reload(*uav.profile);
  for (Condition& condition : scenario.conditions)
    for (Profile& profile : condition.profiles) reload(profile);
  for (const Setting& setting : settings)
    if (!replaced.contains(setting.key))
      throw Error(ErrorCode::kUsage, {scenario.file.string()},
                  fmt::format("has no value '{}' to replace. Give the path of a key that the file "
                              "or a profile of its sensors has, such as time_limit_s, "
                              "condition.cpu_factor, sut.parameters.KEY or sensors.camera.rate_hz",
                              setting.key))
          .about(setting.key);
}

std::string name_suffix(const std::vector<Setting>& settings) {
  std::string suffix;
  for (const auto& [key, value] : settings) {
    const bool is_path = value.find('/') != std::string::npos;
    suffix += "-" + key.substr(key.rfind('.') + 1) + "-" +
              (is_path ? std::filesystem::path(value).stem().string() : value);
  }
  constexpr std::string_view kKept =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-.";
  for (char& c : suffix)
    if (kKept.find(c) == std::string_view::npos) c = '-';
  return suffix;
}

}  // namespace tether::scenario
