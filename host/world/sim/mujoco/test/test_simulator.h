#pragma once

#include <memory>
#include <string>

#include <tether/sim/simulator.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim::testing {

/// Fails the test on any warning.
WarningSink no_warnings();

std::unique_ptr<Simulator> make_simulator(World world);

/// data/worlds/<name> with one UAV, "alpha", and the anchor "blue_box".
World shipped_world(const std::string& name);

}  // namespace tether::sim::testing
