#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <tether/uav/multirotor.h>

namespace tether::autopilot {

/// How ArduPilot knows a vehicle's rotors (ardupilot.org, "Connect ESCs and Motors"): which of its
/// frames they are, and which of its motors each one is.
struct MotorLayout {
  int frame_class = 0;              ///< its parameter FRAME_CLASS
  int frame_type = 0;               ///< and FRAME_TYPE
  std::vector<std::size_t> motors;  ///< of each rotor; the first is 0
};

/// None: no frame has rotors at these angles that turn so. Angles may be 10 degrees off.
std::optional<MotorLayout> motor_layout(const std::vector<uav::Rotor>& rotors);

}  // namespace tether::autopilot
