#pragma once

#include "external/readings.h"

#include <cstddef>
#include <vector>

#include <tether/base/time.h>
#include <tether/mavlink/message.h>
#include <tether/uav/samples.h>

/// What a simulation in the loop tells a flight controller, as messages of MAVLink (mavlink.io,
/// "HIL_SENSOR", "HIL_GPS", "HIL_ACTUATOR_CONTROLS"). Pure functions.
namespace tether::autopilot {

/// `at` is the controller's own clock.
mavlink::Message hil_sensor(Duration at, const Readings& readings);
mavlink::Message hil_gps(Duration at, const uav::NavSatSample& position);

/// Shares of the rotors' largest speed.
std::vector<double> rotor_shares(const mavlink::Message& controls, std::size_t rotors);

}  // namespace tether::autopilot
