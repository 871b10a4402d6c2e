#include "test_simulator.h"

#include <gtest/gtest.h>

#include <tether/sim_mujoco/mujoco_simulator.h>

namespace tether::sim::testing {

WarningSink no_warnings() {
  return [](const Warning& warning) { ADD_FAILURE() << to_line(warning); };
}

std::unique_ptr<Simulator> make_simulator(World world) {
  return make_mujoco_simulator(std::move(world), no_warnings());
}

}  // namespace tether::sim::testing
