#pragma once

#include <string>

namespace tether::sim {

/// GAZEBO_MASTER_URI, with which the user's own tools find the server; empty: not set.
/// @throws Error(kSetup) about it unless it is http://HOST:PORT with this machine as the host.
std::string master_of_user();

}  // namespace tether::sim
