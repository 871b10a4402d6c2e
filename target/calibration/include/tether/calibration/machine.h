#pragma once

#include <optional>
#include <string>

#include <tether/base/result.h>
#include <tether/calibration/calibration.h>

/// The machine that this program runs on, as /proc and /sys tell of it where they do, and its
/// clock.
namespace tether::calibration {

/// "unknown host" if it does not tell.
std::string host_name();

/// `root` is "" but for tests, which put /proc and /sys below another folder. Frequencies are left
/// at 0.
Machine read_machine(const std::string& root = "");

/// Clock rate of a core [MHz]; 0: it does not tell.
double read_mhz(int cpu_index, const std::string& root = "");

/// Binds this process to one core: that one, or else the last that it may use. Returns which; fails
/// (kInvalid) if it may not use that one.
Result<int> bind_to_core(std::optional<int> cpu_index);

/// Reads the governor of that core into `machine`.
void read_governor(int cpu_index, Machine& machine, const std::string& root = "");

/// Now, as files say when they were made: "2026-01-31T12:00:00Z".
std::string utc_now();

}  // namespace tether::calibration
