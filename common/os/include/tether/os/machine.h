#pragma once

#include <cstddef>
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

/// Raises the number of descriptors that this process, and those that it starts, may have open to
/// `count`, if fewer are allowed. How many are allowed then: fewer if the system allows no more.
std::size_t allow_descriptors(std::size_t count);

}  // namespace tether::os
