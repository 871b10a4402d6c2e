#pragma once

#include "commands/size_options.h"

#include <stop_token>

namespace tether::app {

/// `tether size --axis uavs`: checks the question, flies the first UAVs of the scenario until it is
/// known how many of them the board carries, and writes the answer. @return the exit code.
int find_uavs(const SizeOptions& options, const std::stop_token& stop);

}  // namespace tether::app
