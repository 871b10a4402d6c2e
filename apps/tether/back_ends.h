#pragma once

#include <string>

#include <tether/runner/trial.h>

namespace tether::app {

/// The simulator with that name in `--simulator` or a condition: "mujoco", "gazebo", or an address,
/// "unix:/path" or "tcp://host:port". Starts nothing.
/// @throws Error(kUsage) about any other text.
runner::BackEnd find_back_end(const std::string& name);

}  // namespace tether::app
