#pragma once

#include <string>

namespace tether::sim {

/// GAZEBO_MASTER_URI, which is the user's choice so that his own tools find the server; empty: not
/// set.
/// @throws Error(kSetup) naming it where gzserver could not serve there: it is not http://HOST:PORT
/// with this machine as the host.
std::string master_of_user();

}  // namespace tether::sim
