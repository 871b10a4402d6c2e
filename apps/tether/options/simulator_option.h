#pragma once

#include <string>
#include <variant>

#include <tether/sim_protocol/connection.h>

namespace tether::app {

/// In this process.
struct EmbeddedSimulator {};
/// Gazebo 11, started and ended by this program.
struct GazeboSimulator {};

/// The simulator to use. An Endpoint is the address of an external simulator.
using SimulatorOption = std::variant<EmbeddedSimulator, GazeboSimulator, sim::protocol::Endpoint>;

/// Parses "mujoco", "gazebo", "unix:/path" or "tcp://host:port".
/// @throws Error(kUsage) about any other text.
SimulatorOption parse_simulator_option(const std::string& text);

}  // namespace tether::app
