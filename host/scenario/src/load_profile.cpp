#include "read_sensor_profile.h"

#include <tether/scenario/profile.h>
#include <tether/toml/table.h>

namespace tether::scenario {

Profile load_profile(const std::filesystem::path& file) {
  Profile profile;
  profile.file = std::filesystem::absolute(file).lexically_normal();
  profile.files = {profile.file};
  const toml::Document document = toml::Document::load(profile.file);
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
