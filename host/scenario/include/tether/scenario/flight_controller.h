#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <string>

#include <tether/base/error.h>
#include <tether/base/time.h>

namespace tether::scenario {

/// The flight controller of a UAV: to its program, the UAV is what it is behind that.
struct FlightController {
  enum class Kind { kBuiltIn, kPx4 };
  Kind kind = Kind::kBuiltIn;
  std::filesystem::path path{};              ///< of PX4's build; absolute
  Duration boot = std::chrono::seconds(30);  ///< of PX4's time, before the flight
  double link_baud = 0.0;                    ///< of the line to the program; 0: bytes take no time
  Duration link_latency{0};                  ///< each way
  bool starts_in_air = false;                ///< of the built-in one
  std::map<std::string, double> parameters{};
  FileLocation at{};
};

}  // namespace tether::scenario
