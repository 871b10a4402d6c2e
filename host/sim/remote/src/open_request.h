#pragma once

#include <vector>

#include <tether/sim/world.h>
#include <tether/sim_protocol/messages.h>

namespace tether::sim {

/// What a simulator outside is told of the world, whose file it reads itself. `warn` is told of
/// what it cannot have.
/// @throws Error(kBadFile) for a world that comes from no file, and as `shutter_steps` does.
protocol::Open make_open(const World& world, const WarningSink& warn);

/// How far each of `moving_bodies` reaches from its origin, as it is drawn [m]; rather too much.
/// @throws Error(kBadFile) for a mesh that cannot be read.
std::vector<double> drawn_radii_m(const World& world);

}  // namespace tether::sim
