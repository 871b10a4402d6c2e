#include "project_folder.h"

#include <tether/scenario/profile.h>

/// Profiles of sensors. Input: the file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  static const fuzz::ProjectFolder folder;
  const auto file = folder.write("input.toml", {data, size});
  const auto read = fuzz::read_or_refuse([&] { return scenario::load_profile(file); });
  if (!read) return 0;
  fuzz::require(!read->name.empty() && read->file.is_absolute(), "a profile without a name");
  fuzz::require(!read->sensors.empty(), "a profile of nothing");
  for (const auto& [name, sensor] : read->sensors) {
    fuzz::require(!name.empty() && sensor.kind.has_value(), "a sensor without a name or kind");
    if (sensor.kind != uav::SensorKind::kRange) continue;
    sim::Sensor range{name, {}, 0.0, sim::RangeModel{}};
    for (const scenario::SensorSetting& setting : sensor.settings) setting.set(range);
    fuzz::require(std::get<sim::RangeModel>(range.model).max_m >= 0.0, "a negative range");
  }
  return 0;
}
