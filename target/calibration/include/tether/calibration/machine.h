#pragma once

#include <optional>
#include <string>

#include <tether/base/result.h>
#include <tether/calibration/calibration.h>

/// The machine that this program runs on, from /proc and /sys, and its clock.
namespace tether::calibration {

/// The host's name; "unknown host" if it is not known.
std::string host_name();

/// `root` contains /proc and /sys; only tests set it. Frequencies stay 0.
Machine read_machine(const std::string& root = "");

/// Clock rate of a core [MHz]; 0: unknown.
double read_mhz(int cpu_index, const std::string& root = "");

/// Binds this process to the given core, or to the last one available. Returns the core. Fails with
/// kInvalid if the core is not available.
Result<int> bind_to_core(std::optional<int> cpu_index);

/// Reads the governor of that core into `machine`.
void read_governor(int cpu_index, Machine& machine, const std::string& root = "");

}  // namespace tether::calibration
