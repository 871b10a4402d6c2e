#include "options/simulator_option.h"

#include <fmt/format.h>

#include <tether/base/error.h>

namespace tether::app {

SimulatorOption parse_simulator_option(const std::string& text) {
  if (text == "mujoco") return EmbeddedSimulator{};
  if (text == "gazebo") return GazeboSimulator{};
  if (const auto endpoint = sim::protocol::parse_endpoint(text)) return *endpoint;
  throw Error(ErrorCode::kUsage,
              fmt::format("unknown simulator \"{}\". Use mujoco, gazebo, or the address of an "
                          "external simulator, unix:/path or tcp://host:port",
                          text))
      .about(text);
}

}  // namespace tether::app
