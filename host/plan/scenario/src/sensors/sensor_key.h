#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <tether/base/error.h>
#include <tether/scenario/profile.h>
#include <tether/sim/world.h>
#include <tether/toml/table.h>
#include <tether/uav/sensor_timing.h>

/// The keys of a sensor's table, as rows. Each kind of sensor has a file in this folder with its
/// rows (`keys_of`) and with what its values must be together (`complete`).
namespace tether::scenario {

/// A key of a sensor's table: reads its value, and returns what sets it in a sensor.
struct SensorKey {
  std::string_view name;
  std::function<SensorSetter(const toml::Table& table, std::string_view key)> read;
};

/// The row of a key: `read(table, name)` gives its value, and `set` is the member of `Model` that
/// becomes that value, or a function that is called with the model and the value.
template <class Model>
SensorKey row(std::string_view name, auto read, auto set) {
  return {name, [read, set](const toml::Table& table, std::string_view key) -> SensorSetter {
            return [set, value = read(table, key)](sim::Sensor& sensor) {
              Model& model = std::get<Model>(sensor.model);
              if constexpr (std::is_member_object_pointer_v<decltype(set)>)
                model.*set = value;
              else
                set(model, value);
            };
          }};
}

// Readers.

/// A number in this range; multiplied by `factor` it is in the model's unit.
inline auto number(toml::Range range, double factor = 1.0) {
  return [range, factor](const toml::Table& table, std::string_view key) {
    return table.number(key, range) * factor;
  };
}
inline bool boolean(const toml::Table& table, std::string_view key) {
  return table.boolean(key);
}
/// The table of a channel's noise. An empty one is no noise.
sim::Noise noise(const toml::Table& table, std::string_view key);

inline constexpr toml::Range kProbability{.min = 0.0, .max = 1.0};
inline constexpr toml::Range kDistance_m{.min = 0.0, .max = 1e5};
inline constexpr toml::Range kFarthest_m{.min = 0.0, .max = 1e5, .above_min = true};

/// What the layers set of one sensor.
class Laid {
 public:
  void add(const SensorProfile& layer) { layers_.push_back(&layer); }
  bool has(std::string_view key) const { return !at({key}).file.empty(); }
  /// In the last layer that sets one of the keys: the first of them that it sets. Empty: none does.
  FileLocation at(std::initializer_list<std::string_view> keys) const;

 private:
  std::vector<const SensorProfile*> layers_;
};

/// A sensor whose layers are all laid.
struct Finished {
  const std::string& name;
  const uav::SensorTiming& timing;
  const Laid& laid;

  /// Refuses the key, which a layer sets, because of what the sensor is in SDF.
  [[noreturn]] void unfit(std::string_view key, std::string_view reason) const;
  /// Refuses values that exclude each other, at the last that was set.
  [[noreturn]] void refuse(std::initializer_list<std::string_view> keys,
                           const std::string& problem) const;
  /// That `min_m` is less than `max_m`.
  void check_limits(double min_m, double max_m) const;
};

// The kinds.

std::vector<SensorKey> keys_of(std::type_identity<sim::CameraModel>);
std::vector<SensorKey> keys_of(std::type_identity<sim::ImuModel>);
std::vector<SensorKey> keys_of(std::type_identity<sim::RangeModel>);
std::vector<SensorKey> keys_of(std::type_identity<sim::NavSatModel>);
std::vector<SensorKey> keys_of(std::type_identity<sim::MagnetometerModel>);
std::vector<SensorKey> keys_of(std::type_identity<sim::BarometerModel>);
std::vector<SensorKey> keys_of(std::type_identity<sim::OdometryModel>);
std::vector<SensorKey> keys_of(std::type_identity<sim::ScanModel>);
std::vector<SensorKey> keys_of(std::type_identity<sim::JointStateModel>);

/// Sets what follows from other values, and checks what the values are together.
/// @throws Error(kBadFile)
void complete(sim::CameraModel& camera, const Finished& sensor);
void complete(sim::RangeModel& range, const Finished& sensor);
void complete(sim::NavSatModel& navsat, const Finished& sensor);
void complete(sim::ScanModel& scan, const Finished& sensor);
/// Of a kind whose values can have any combination.
void complete(auto&, const Finished&) {}

/// The rows of that kind, in the order in which they are set.
const std::vector<SensorKey>& keys_of(uav::SensorKind kind);
/// All kinds.
inline constexpr std::size_t kSensorKinds = std::variant_size_v<decltype(sim::Sensor::model)>;

}  // namespace tether::scenario
