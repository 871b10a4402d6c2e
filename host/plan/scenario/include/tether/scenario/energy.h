#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <tether/base/error.h>
#include <tether/energy/meter.h>

/// What a UAV needs to fly, and what its battery has (data/energy/*.toml).
namespace tether::scenario {

struct Energy {
  std::filesystem::path file;  ///< absolute
  energy::Model model;         ///< without `battery` if the file has none
  bool has_battery = false;    ///< else the battery is that of the UAV's SDF file
  FileLocation rotor_at;
  FileLocation battery_at;  ///< of the file itself if it has none
};

/// Reads and checks an energy file (docs/guide/energy.md).
/// @throws Error(kBadFile) as `load_scenario`, also of a battery that cannot exist.
Energy load_energy(const std::filesystem::path& file);

}  // namespace tether::scenario
