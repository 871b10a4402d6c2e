#pragma once

#include <string>
#include <variant>

#include <tether/sim_protocol/connection.h>

namespace tether::app {

/// In this process.
struct EmbeddedSimulator {};
/// Gazebo 11, which this program starts and ends.
struct GazeboSimulator {};

/// Which simulator plays the world: one of ours, or one that somebody else has started and that
/// listens there.
using SimulatorOption = std::variant<EmbeddedSimulator, GazeboSimulator, sim::protocol::Endpoint>;

/// "mujoco", "gazebo", "unix:/path" or "tcp://host:port".
/// @throws Error(kUsage) for anything else.
SimulatorOption parse_simulator_option(const std::string& text);

}  // namespace tether::app
