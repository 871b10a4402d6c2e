#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <tether/base/error.h>
#include <tether/sim/world.h>

/// What differs from flight to flight (docs/guide/scenario.md): the tables [vary.NAME].
namespace tether::scenario {

struct Uniform {
  double least = 0.0, most = 0.0;
};
struct Normal {
  double mean = 0.0, stddev = 0.0;
};
struct OneOf {
  std::vector<double> values;  ///< at least one, equally probable
};
using Distribution = std::variant<Uniform, Normal, OneOf>;

/// A quantity of the world, and how it is drawn.
struct Variation {
  std::string name;      ///< of its table
  std::string quantity;  ///< "start_x_m", "mass_factor", "model_yaw_deg", …
  std::string of;        ///< the UAV, model or UAV.SENSOR; empty: each UAV, or the whole world
  Distribution distribution;
  FileLocation at;

  /// "start_x_m of uav1".
  std::string text() const;
};

/// The value that a flight got.
struct Varied {
  std::string name;
  std::string what;  ///< Variation::text
  double value = 0.0;

  friend bool operator==(const Varied&, const Varied&) = default;
};

/// The names of all quantities.
std::vector<std::string_view> quantities();

/// Draws the values of a flight and changes `world` by them, but for mountings of sensors, which
/// profiles may replace: see `vary_mountings`. Models are placed again, up to 100 times, until they
/// touch nothing that they do not touch in the file; meshes are not looked at. The same seed always
/// gives the same world.
/// `is_read_elsewhere`: an external simulator reads the world's file itself.
/// @throws Error(kBadFile) at the table: `of` names nothing, a value is impossible (a mass that is
///   not above 0), there is no room for a model, or the simulator would not see the change.
std::vector<Varied> vary(const std::vector<Variation>& variations, std::uint64_t seed,
                         bool is_read_elsewhere, sim::World& world);
/// Turns and moves the sensors. @pre after `resolve_sensors`
void vary_mountings(const std::vector<Variation>& variations, const std::vector<Varied>& values,
                    sim::World& world);

}  // namespace tether::scenario
