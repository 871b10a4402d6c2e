#include "options/simulator_option.h"

#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::app {
namespace {

TEST(SimulatorOption, IsANameOrAnAddress) {
  EXPECT_TRUE(std::holds_alternative<EmbeddedSimulator>(parse_simulator_option("mujoco")));
  EXPECT_TRUE(std::holds_alternative<GazeboSimulator>(parse_simulator_option("gazebo")));
  for (const std::string address : {"unix:/run/sim.sock", "tcp://lab:4500", "tcp://[::1]:4500"})
    EXPECT_EQ(sim::protocol::to_string(
                  std::get<sim::protocol::Endpoint>(parse_simulator_option(address))),
              address);
  for (const std::string text :
       {"", "Gazebo", "unix:", "tcp://lab", "ssh://lab:22", "/run/sim.sock"})
    EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { parse_simulator_option(text); }).subject(),
              text);
}

}  // namespace
}  // namespace tether::app
