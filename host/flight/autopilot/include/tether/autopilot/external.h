#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <tether/autopilot/flight_controller.h>
#include <tether/sim/world.h>

/// Flight controllers that the user brings: programs of their own, on one core, whose clock is ST
/// plus the time of their boot. Their sensors are those of the vehicle, and their actuators are its
/// rotors.
namespace tether::autopilot {

struct ExternalSettings {
  std::filesystem::path build;   ///< folder of the controller's build
  std::filesystem::path folder;  ///< for its files, among them its logs; made anew
  int instance = 0;              ///< of the run; its system's id is one more
  std::uint64_t seed = 0;        ///< of the noise that is added to its sensors
  Duration period{0};            ///< between two steps
  sim::Place place{};            ///< of W
  uav::Vec3 magnetic_field_T;    ///< in W
  double gravity_m_s2 = 0.0;
  sim::Uav vehicle;                            ///< where it starts, its rotors and sensors
  std::map<std::string, double> parameters{};  ///< of the controller, by name
  Duration boot{0};                            ///< of its time, at most, before the flight
};

/// A kind of such flight controllers.
struct External {
  std::string_view key;   ///< in scenarios
  std::string_view name;  ///< for people
  Duration period;        ///< of its steps, or the next multiple of the simulator's step
  Duration boot;          ///< for the longest boot, if the user gives none
  std::size_t most_uavs;  ///< of a run; with more, ports or ids would be the same
  bool has_fixed_ports;   ///< the same in each run: runs cannot be parallel
  bool repeats;           ///< it answers in the same way in each run
  /// Starts it. @throws Error(kSetup) if it cannot be started, or a port is in use.
  /// Steps of the controller throw Error(kLinkLost) if it ends, and Error(kHung) if it does not
  /// answer or does not come to rest.
  std::unique_ptr<FlightController> (*start)(const ExternalSettings& settings);
};

/// PX4, compiled for its software in the loop ("SITL"), held at each of its steps until it has come
/// to rest. A little noise is added to its sensors, without which it takes them for broken. It is
/// told by parameters where the rotors are. (docs.px4.io, "Simulation"; mavlink.io, "HIL_SENSOR".)
///
/// ArduPilot's ArduCopter, compiled for its SITL, with its interface "JSON": it sends servos, and
/// computes nothing until it has the answer. (ardupilot.org, "SITL with JSON".)
std::span<const External> externals();

/// Whether a parameter of these can have this name: at most 16 capital letters, digits and '_'.
bool is_external_parameter(std::string_view name);

}  // namespace tether::autopilot
