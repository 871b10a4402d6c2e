#pragma once

#include <cstdint>
#include <memory>

#include <tether/autopilot/flight_controller.h>

namespace tether::autopilot {

/// What a ground station on this machine may do.
enum class GroundStation {
  kAbsent,
  kLooks,     ///< it sees what the controller sends, and its commands are denied
  kCommands,  ///< what it sends reaches the controller at its next step: runs do not repeat
};

/// The port at which ground stations listen.
inline constexpr std::uint16_t kGroundStationPort = 14550;

/// The same controller, which also sends to that UDP port of this machine, where a ground station
/// may listen or not. A controller that is only looked at does the same as without it: nothing is
/// waited for, and what finds no room is lost.
/// @throws Error(kSetup) if no socket can be had
std::unique_ptr<FlightController> with_ground_station(std::unique_ptr<FlightController> controller,
                                                      GroundStation what, std::uint16_t port);

}  // namespace tether::autopilot
