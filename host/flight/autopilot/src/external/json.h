#pragma once

#include "external/readings.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <tether/autopilot/flight_controller.h>
#include <tether/base/time.h>
#include <tether/sim/world.h>
#include <tether/uav/multirotor.h>

/// The datagrams between ArduPilot and a simulator of its model "JSON" (ardupilot.org, "SITL with
/// JSON"). Pure functions.
namespace tether::autopilot {

/// What ArduPilot sends at each of its steps.
struct Servos {
  static constexpr std::size_t kCount = 16;
  std::uint32_t step = 0;                   ///< counts them; the same again: it waits
  std::array<std::uint16_t, kCount> pwm{};  ///< [µs]; 0: none
};
/// None: the bytes are no such datagram.
std::optional<Servos> decode_servos(const Bytes& bytes);

/// The answer: what the vehicle does at this instant of ArduPilot's clock. ArduPilot makes its own
/// positions, fields and pressures of the true state, with noise of its own.
std::string json_state(Duration at, const sim::Place& place, const uav::BodyState& truth,
                       const Readings& readings);

/// The share of a motor's full speed.
double share_of_pwm(std::uint16_t pwm_us);

}  // namespace tether::autopilot
