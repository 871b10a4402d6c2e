#pragma once

#include "statistics.h"

#include <string>

#include <tether/calibration/calibration.h>

/// What people read of a calibration, and the target file that comes of it.
namespace tether::calibration {

/// "bench-pi (Raspberry Pi 4 Model B, aarch64)".
std::string machine_line(const Machine& machine);

/// The machine, the median and the spread of each block, and what makes them doubtful.
std::string speed_table(const Calibration& calibration);

/// How many times longer `there` takes, block by block and overall, and how good a single factor
/// would be.
std::string comparison_table(const Calibration& here, const Calibration& there,
                             const Comparison& comparison);

/// A virtual target's file (docs/guide/target.md): `there`, as `here` can stand in for it. Its
/// factor is that of the whole step. @pre is_profile_name(name)
std::string target_text(const std::string& name, const Calibration& here, const Calibration& there,
                        const Comparison& comparison);

}  // namespace tether::calibration
