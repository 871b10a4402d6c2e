#include "files/settings.h"
#include "tables/read_sensor_profile.h"

#include <string_view>

#include <tether/scenario/profile.h>
#include <tether/toml/table.h>

namespace tether::scenario {
namespace {

constexpr std::string_view kSensors = "sensors.";

/// "sensors.NAME.KEY", of a table that the file has: such a key may be new.
bool is_of_a_sensor(std::string_view path, const toml::Table& root) {
  const std::string_view rest = path.substr(kSensors.size());
  const std::size_t dot = rest.find('.');
  return dot != std::string_view::npos && rest.find('.', dot + 1) == std::string_view::npos &&
         root.has("sensors") && root.table("sensors").has(rest.substr(0, dot));
}

}  // namespace

Profile load_profile(const std::filesystem::path& file) {
  std::set<std::string> none;
  return load_profile(file, {}, none);
}

Profile load_profile(const std::filesystem::path& file, const std::vector<Setting>& settings,
                     std::set<std::string>& replaced) {
  Profile profile;
  profile.file = std::filesystem::absolute(file).lexically_normal();
  profile.files = {profile.file};
  toml::Document document = toml::Document::load(profile.file);
  for (const auto& [key, value] : settings) {
    const std::string path = key.substr(key.starts_with("uav.") ? 4 : 0);
    if (!path.starts_with(kSensors)) continue;
    if (document.replace(path, value) > 0 ||
        (is_of_a_sensor(path, document.root()) && document.add(path, value) > 0))
      replaced.insert(key);
  }
  const toml::Table root = document.root({"name", "description", "sensors"});
  profile.name = root.identifier("name");
  profile.description = root.text_or("description", "");
  const toml::Table sensors = root.table("sensors");
  if (sensors.keys().empty()) {
    root.fail("sensors", "names no sensor. Add a table [sensors.NAME] for each.");
  }
  for (const std::string& name : sensors.keys()) {
    profile.sensors.emplace(name,
                            read_sensor_profile(sensors, name, KindKey::kRequired, profile.files));
  }
  return profile;
}

}  // namespace tether::scenario
