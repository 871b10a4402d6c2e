#pragma once

#include <string>
#include <vector>

namespace tether::os {

/// The machine in one line: CPU model, cores, kernel.
std::string describe_machine();

/// Number of cores of this machine, including cores that this process may not use or that are
/// switched off; 0 if unknown.
int machine_cores();

/// Number of cores that this process may use. CPUs that share a core (simultaneous multithreading)
/// count once.
int separate_cores();

/// The CPUs that this process may run on, ascending.
std::vector<int> allowed_cpus();

}  // namespace tether::os
