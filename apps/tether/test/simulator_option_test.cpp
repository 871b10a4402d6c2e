#include "simulator_option.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::app {
namespace {

using testing::HasSubstr;

TEST(SimulatorOption, TellsOursAndAddressesApart) {
  EXPECT_TRUE(std::holds_alternative<EmbeddedSimulator>(parse_simulator_option("mujoco")));
  EXPECT_TRUE(std::holds_alternative<GazeboSimulator>(parse_simulator_option("gazebo")));
  for (const std::string address : {"unix:/run/sim.sock", "tcp://lab:4500", "tcp://[::1]:4500"}) {
    const SimulatorOption option = parse_simulator_option(address);
    ASSERT_TRUE(std::holds_alternative<sim::protocol::Endpoint>(option)) << address;
    EXPECT_EQ(sim::protocol::to_string(std::get<sim::protocol::Endpoint>(option)), address);
  }
}

TEST(SimulatorOption, AnythingElseIsWrongUseThatSaysWhatIsAllowed) {
  for (const std::string text :
       {"", "Gazebo", "unix:", "tcp://lab", "ssh://lab:22", "/run/sim.sock"}) {
    const std::string message =
        error_message(ErrorCode::kUsage, [&] { parse_simulator_option(text); });
    EXPECT_THAT(message, HasSubstr("\"" + text + "\""));
    EXPECT_THAT(message, HasSubstr("mujoco, gazebo, or where one listens"));
  }
}

}  // namespace
}  // namespace tether::app
