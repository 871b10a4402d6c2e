#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/time.h>
#include <tether/sim/geodesy.h>
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

/// What is wrong with the content of a file with a key for signatures of MAVLink 2: it has 32
/// bytes, or 64 hexadecimal digits. Empty: nothing.
std::string complaint_about_signing_key(std::string_view content);

/// The same controller, whose link to the companion is signed with that key, both ways: what is not
/// signed, wrongly, or comes again is refused. Its clock begins on 2026-01-01, as that of programs
/// as they are. @pre the key is right
std::unique_ptr<FlightController> with_signing(std::unique_ptr<FlightController> controller,
                                               std::string_view key);

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

/// Between two steps of the built-in controller; a multiple of the simulator's step is used.
inline constexpr Duration kBuiltInPeriod = std::chrono::milliseconds(4);

struct BuiltInSettings {
  std::uint8_t system_id = 1;
  sim::Place place{};  ///< of W
  uav::FlightLimits limits{};
  double hover_thrust_N = 0.0;
  bool starts_in_air = false;                  ///< armed, in Hold; else landed and disarmed
  std::map<std::string, double> parameters{};  ///< values of parameters, by name
  double link_baud = 0.0;  ///< half of it is for telemetry, as PX4 does it; 0: any rate
};

/// The built-in flight controller. It behaves at its port as PX4's documentation says of a
/// multicopter (docs.px4.io, "Flight Modes", "Offboard Mode", "Safety"): modes, arming checks,
/// acknowledgements, parameters, missions, the rule of the set-point stream and its failsafe. The
/// words are in docs/guide/flight-controllers.md. It flies on the vehicle's odometry, if it has
/// such a sensor, else on the truth; the set-points that it gives are those of the truth which move
/// the estimate where it should go.
/// @pre the parameters are known, and within their limits (`complaint_about_parameter`)
std::unique_ptr<FlightController> make_built_in(const BuiltInSettings& settings);

/// What is wrong with a value of a parameter: the name is not known, or the value is out of its
/// limits. Empty: nothing.
std::string complaint_about_parameter(const std::string& name, double value);

}  // namespace tether::autopilot
