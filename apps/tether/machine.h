#pragma once

#include <string>

namespace tether::app {

/// The machine in one line: CPU model, cores, kernel.
std::string describe_machine();

/// Cores that this machine has, whether or not this process may use them, or they are switched on
/// now; 0: not known, or more than a run can tell.
int machine_cores();

}  // namespace tether::app
