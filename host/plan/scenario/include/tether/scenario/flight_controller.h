#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include <tether/base/error.h>
#include <tether/base/time.h>

namespace tether::autopilot {
struct External;
enum class GroundStation;
}  // namespace tether::autopilot

namespace tether::scenario {

/// The flight controller of a UAV: to its program, the UAV is what it is behind that.
struct FlightController {
  const autopilot::External* external = nullptr;  ///< one that the user brings; nullptr: built-in
  std::filesystem::path path{};                   ///< of its build; absolute
  Duration boot{0};                               ///< of its time, at most, before the flight
  double link_baud = 0.0;        ///< of the line to the program; 0: bytes take no time
  Duration link_latency{0};      ///< each way
  bool starts_in_air = false;    ///< of the built-in one
  bool has_fixed_ports = false;  ///< flights with it cannot be parallel
  std::map<std::string, double> parameters{};
  autopilot::GroundStation ground_station{};  ///< what one may do; first: there is none
  std::uint16_t ground_station_port = 0;
  FileLocation at{};
};

}  // namespace tether::scenario
