#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/error.h>
#include <tether/sim/world.h>
#include <tether/uav/catalogue.h>
#include <tether/uav/sensor_timing.h>

/// Profiles (TOML): the properties and the timing of sensors (paper, Section IV), which override
/// SDF (docs/guide/scenario.md). All values here are in their ranges; whether they fit the sensor
/// and each other is checked when they are applied to it.
namespace tether::scenario {

/// Sets one value of a sensor, of the kind that the value is for.
using SensorSetter = std::function<void(sim::Sensor&)>;

/// A key of a sensor's table, as it was read for a kind of sensor.
struct SensorSetting {
  std::optional<uav::SensorKind> kind;  ///< none: any
  SensorSetter set;
};

/// One table about a sensor: [sensors.NAME] of a profile, [uav.sensors.NAME] of a scenario. An
/// empty member leaves the layer below unchanged.
struct SensorProfile {
  FileLocation where;                             ///< of the table's header
  std::map<std::string, int, std::less<>> lines;  ///< of each of its keys

  std::optional<uav::SensorKind> kind;  ///< always set in a profile

  /// Replaces the timing below as a whole, its delay included.
  std::optional<uav::SensorTiming> timing;
  /// Without `timing`: replaces the delay alone.
  std::optional<uav::Delay> delay;

  /// What the other keys set: in this order.
  std::vector<SensorSetting> settings;

  /// The line of the key; of the table's header if the key is missing.
  FileLocation at(std::string_view key) const;
};

struct Profile {
  std::string name;  ///< letters, digits, '_', '-', '.'
  std::string description;
  std::filesystem::path file;                    ///< absolute
  std::map<std::string, SensorProfile> sensors;  ///< at least one, by name; each has a kind
  /// The profile itself and its files of delays; absolute.
  std::vector<std::filesystem::path> files;
};

/// Reads and checks a profile. Paths in it are relative to its own folder.
/// @throws Error(kBadFile) as `load_scenario`.
Profile load_profile(const std::filesystem::path& file);

}  // namespace tether::scenario
