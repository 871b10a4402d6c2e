#pragma once

#include <vector>

#include <tether/sim/world.h>
#include <tether/sim_protocol/messages.h>

namespace tether::sim {

/// The request with which an external simulator opens the world, whose file it reads itself. `warn`
/// receives a line for each thing that it cannot represent.
/// @throws Error(kBadFile) about a world that has no file, and as `shutter_steps` does.
protocol::Open make_open(const World& world, const WarningSink& warn);

/// An upper bound of the drawn extent of each of `moving_bodies` from its origin [m].
/// @throws Error(kBadFile) for a mesh that cannot be read.
std::vector<double> drawn_radii_m(const World& world);

}  // namespace tether::sim
