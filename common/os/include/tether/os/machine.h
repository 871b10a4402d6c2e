#pragma once

#include <cstddef>
#include <ctime>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tether/base/time.h>

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

/// Time of all CPUs since the start of the machine, added up.
struct ProcessorTime {
  Duration used{0};    ///< by programs and the kernel
  Duration stolen{0};  ///< wanted, but given to other virtual machines
  Duration idle{0};

  friend bool operator==(const ProcessorTime&, const ProcessorTime&) = default;
};
/// None: the kernel does not tell.
std::optional<ProcessorTime> processor_time();
/// The same from the first line of /proc/stat, whose unit is `tick`.
std::optional<ProcessorTime> parse_processor_time(std::string_view line, Duration tick);

/// Raises the number of descriptors that this process, and those that it starts, may have open to
/// `count`, if fewer are allowed. How many are allowed then: fewer if the system allows no more.
std::size_t allow_descriptors(std::size_t count);

/// The reading of a clock of this machine: CLOCK_MONOTONIC, or the CPU time of a process or thread.
Duration read_clock(clockid_t clock);

/// The current time as in files: "2026-01-31T12:00:00Z".
std::string utc_now();

/// Sleeps until CLOCK_MONOTONIC reads that; returns at once if that is past.
void sleep_until(Duration monotonic);

}  // namespace tether::os
