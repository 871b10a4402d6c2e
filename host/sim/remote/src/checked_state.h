#pragma once

#include <string>

#include <tether/sim/bodies.h>
#include <tether/sim_protocol/messages.h>

namespace tether::sim {

/// `simulator`: how messages begin. @throws Error(kSetup), naming the body, where one is farther
/// from the origin than any world reaches.
void check_reach(const World& world, const protocol::State& state, const std::string& simulator);

/// @throws Error(kSetup), with what was expected and what came, where a body does not begin where
/// the world says, or a UAV not at rest.
void check_start(const World& world, const protocol::State& state, const std::string& simulator);

}  // namespace tether::sim
