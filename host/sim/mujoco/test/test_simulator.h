#pragma once

#include <memory>

#include <tether/sim/simulator.h>
#include <tether/sim_testing/test_worlds.h>

namespace tether::sim::testing {

/// Fails the test on any warning.
WarningSink no_warnings();

std::unique_ptr<Simulator> make_simulator(World world);

}  // namespace tether::sim::testing
