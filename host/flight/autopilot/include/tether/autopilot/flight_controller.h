#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/time.h>
#include <tether/uav/multirotor.h>
#include <tether/uav/samples.h>
#include <tether/uav/setpoint.h>

/// The flight controller as a part of the simulated vehicle: it has a computer of its own, so its
/// computing is free, and its clock is ST. The SUT is its companion, and talks MAVLink to it.
namespace tether::autopilot {

/// A message on the link to the companion, as a datagram.
using Bytes = std::vector<std::uint8_t>;

/// What the controller is given at one of its steps.
struct Sensed {
  SimTime at;
  uav::BodyState truth;  ///< in W; to fly on if the vehicle has no state estimator
  std::optional<uav::BatterySample> battery{};
  /// A measurement of the vehicle's sensor of that kind at this instant; none: it has none.
  std::function<std::optional<uav::Sample>(uav::SensorKind)> measure{};
};

/// What it does.
struct Actions {
  std::optional<uav::Setpoint> setpoint{};  ///< followed from now on; none: as before
  std::vector<Bytes> sent;                  ///< to the companion, in this order
  /// What a ground station had sent, and the controller took.
  std::vector<Bytes> of_station{};
  /// Of what it received, in that order: messages that were not taken, and why: "not_signed", …, or
  /// "ignored", a set-point that it cannot fly, or that is for another system.
  struct Refusal {
    std::size_t received = 0;
    std::string_view why;
  };
  std::vector<Refusal> refused{};
};

/// Called in the order of time. The built-in one is deterministic: a function of what it was given.
/// Not thread-safe.
class FlightController {
 public:
  virtual ~FlightController() = default;
  FlightController(const FlightController&) = delete;
  FlightController& operator=(const FlightController&) = delete;

  /// Before the first step: it boots on the ground, where nothing moves. Each measurement is
  /// another one, all of ST 0. @throws Error(kSetup) if it does not boot
  virtual void boot(const Sensed& at_rest) { static_cast<void>(at_rest); }
  /// One step: `received` has what has arrived from the companion since the last one, in order.
  /// Whatever it contains, nothing fails for it.
  /// @throws Error of a controller that is a process of its own, and was lost
  virtual Actions step(const Sensed& sensed, const std::vector<Bytes>& received) = 0;
  /// Of a controller that the user brings; empty: it has none, or is not known.
  virtual std::string version() const { return ""; }

 protected:
  FlightController() = default;
};

/// A message as the record has it.
struct Decoded {
  std::string name;         ///< of its type; empty: the bytes are no message of the table
  std::string fields_json;  ///< a JSON object: its fields by name, arrays as arrays, NaN as null
};
/// The messages of a datagram. Bytes that are none make one entry without a name.
std::vector<Decoded> decode(const Bytes& bytes);

}  // namespace tether::autopilot
