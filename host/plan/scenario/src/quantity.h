#pragma once

#include <span>
#include <string_view>

#include <tether/sim/world.h>
#include <tether/toml/table.h>

/// What can differ from flight to flight, as rows of one table.
namespace tether::scenario {

/// Which part of the world a quantity belongs to. kStart: where a UAV starts. kPath: of a model
/// with a path. kWind: of a world with wind.
enum class Part { kStart, kUav, kModel, kPath, kWorld, kWind, kSensor };

struct Quantity {
  std::string_view name;
  Part part;
  toml::Range allowed;
  /// Only what `part` says is not null.
  void (*change)(sim::World& world, sim::Uav* uav, sim::Model* model, sim::Sensor* sensor,
                 double value);
};

std::span<const Quantity> quantities();

}  // namespace tether::scenario
