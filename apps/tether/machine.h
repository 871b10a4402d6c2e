#pragma once

#include <string>

namespace tether::app {

/// The machine in one line: CPU model, cores, kernel.
std::string describe_machine();

}  // namespace tether::app
