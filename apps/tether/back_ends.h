#pragma once

#include <string>

#include <tether/runner/back_end.h>

namespace tether::app {

/// The simulator with that name in `--simulator` or a condition.
/// @throws Error(kUsage) as parse_simulator_option.
runner::BackEnd find_back_end(const std::string& name);

}  // namespace tether::app
