#pragma once

#include <string>

#include <tether/sim/bodies.h>
#include <tether/sim_protocol/messages.h>

namespace tether::sim {

/// `simulator`: how messages begin. @throws Error(kSetup) about the body that is farther from the
/// origin than positions of a world's file may be.
void check_reach(const World& world, const protocol::State& state, const std::string& simulator);

/// @throws Error(kSetup) about the body that is not at its start pose of the world, or the UAV that
/// is not at rest.
void check_start(const World& world, const protocol::State& state, const std::string& simulator);

}  // namespace tether::sim
