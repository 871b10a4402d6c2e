#include "simulator_option.h"

#include <fmt/format.h>

#include <tether/base/error.h>

namespace tether::app {

SimulatorOption parse_simulator_option(const std::string& text) {
  if (text == "mujoco") return EmbeddedSimulator{};
  if (text == "gazebo") return GazeboSimulator{};
  if (const auto endpoint = sim::protocol::parse_endpoint(text)) return *endpoint;
  throw Error(ErrorCode::kUsage,
              fmt::format("no simulator \"{}\": mujoco, gazebo, or where one listens, "
                          "unix:/path or tcp://host:port",
                          text));
}

void add_simulator_option(CLI::App& command, std::string& simulator) {
  command.add_option("--simulator", simulator,
                     "What plays the world, over what the condition says: mujoco, in this program; "
                     "gazebo, which is started and ended by it; or where a simulator listens, "
                     "unix:/path or tcp://host:port");
}

}  // namespace tether::app
