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
#include <tether/uav/math.h>
#include <tether/uav/sensor_timing.h>

/// Profiles (TOML): the properties and the timing of sensors (paper, Section IV), which override
/// SDF (docs/guide/scenario.md). All values here are in their ranges; whether they fit the sensor
/// and each other is checked when they are applied to it.
namespace tether::scenario {

struct ImageSize {
  int width_px = 0;
  int height_px = 0;
};

/// The coefficients of uav::CameraModel.
struct Distortion {
  double k1 = 0.0, k2 = 0.0, k3 = 0.0, p1 = 0.0, p2 = 0.0;
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

  std::optional<uav::Vec3> p_BS;  ///< mounting [m]
  std::optional<uav::Quat> q_BS;

  // Of a camera.
  std::optional<ImageSize> size;
  std::optional<double> horizontal_fov_rad;  ///< without distortion
  std::optional<Distortion> distortion;
  std::optional<sim::Noise> pixel_noise;  ///< of a depth camera, of depths [m]
  std::optional<double> exposure_s;
  std::optional<double> readout_s;
  std::optional<bool> antialias;

  // Of an IMU; for all three axes.
  std::optional<sim::Noise> angular_velocity_noise;
  std::optional<sim::Noise> linear_acceleration_noise;

  // Of a rangefinder, or of a camera that measures depths.
  std::optional<double> min_m;
  std::optional<double> max_m;

  // Of a rangefinder.
  std::optional<double> resolution_m;
  std::optional<double> field_of_view_rad;
  std::optional<double> dropout_probability;
  std::optional<sim::Noise> range_noise;

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
