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

}  // namespace tether::app
