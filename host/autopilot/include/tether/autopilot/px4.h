#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <tether/autopilot/flight_controller.h>
#include <tether/sim/world.h>

namespace tether::autopilot {

/// Between two steps of PX4, which is that of its own simulations.
inline constexpr Duration kPx4Period = std::chrono::milliseconds(4);

/// With more, companions would share ports.
inline constexpr std::size_t kMostPx4 = 10;

struct Px4Settings {
  std::filesystem::path build;   ///< of PX4's target `px4_sitl_default`: has bin/px4 and etc
  std::filesystem::path folder;  ///< for its files, among them its log; made anew
  int instance = 0;              ///< of PX4; [0, 9]. Its system's id is one more
  std::uint64_t seed = 0;        ///< of the noise of its own sensors
  sim::Place place{};            ///< of W
  uav::Vec3 magnetic_field_T;    ///< in W
  double gravity_m_s2 = 0.0;
  sim::Uav vehicle;                            ///< where it starts, its rotors and sensors
  std::map<std::string, double> parameters{};  ///< of PX4, by name
  Duration boot = std::chrono::seconds(30);    ///< of PX4's time, before the flight begins
};

/// PX4, compiled for its software in the loop ("SITL"), as a process of its own: on one core, and
/// held at each of its steps until it has come to rest. Its clock is ST plus the time of its boot,
/// its sensors are those of the vehicle (with a little noise of their own, without which it takes
/// them for broken; ideal ones for what the vehicle lacks), and its actuators are the vehicle's
/// rotors, whose places and directions it is told by parameters. (docs.px4.io, "Simulation";
/// mavlink.io, "HIL_SENSOR".)
///
/// Starts it, and lets it boot on the ground. Instances have ports of their own.
/// @throws Error(kSetup) if it cannot be started, a port is in use, or it does not connect.
/// Its steps throw Error(kLinkLost) if it ends, and Error(kHung) if it does not come to rest.
std::unique_ptr<FlightController> start_px4(const Px4Settings& settings);

/// Whether a parameter can have this name.
bool is_px4_parameter(const std::string& name);

}  // namespace tether::autopilot
