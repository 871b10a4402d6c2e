#pragma once

#include <string>
#include <vector>

namespace tether::os {

/// The machine in one line: CPU model, cores, kernel.
std::string describe_machine();

/// Cores that this machine has, whether or not this process may use them, or they are switched on
/// now; 0: not known.
int machine_cores();

/// The CPUs that this process may run on, ascending.
std::vector<int> allowed_cpus();

}  // namespace tether::os
