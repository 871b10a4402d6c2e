#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include <tether/autopilot/flight_controller.h>
#include <tether/sim/geodesy.h>

namespace tether::autopilot {

/// Between two steps of the built-in controller; a multiple of the simulator's step is used.
inline constexpr Duration kBuiltInPeriod = std::chrono::milliseconds(4);

struct BuiltInSettings {
  std::uint8_t system_id = 1;
  sim::Place place{};  ///< of W
  uav::FlightLimits limits{};
  double hover_thrust_N = 0.0;
  bool starts_in_air = false;                  ///< armed, in Hold; else landed and disarmed
  std::map<std::string, double> parameters{};  ///< values of parameters, by name
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
