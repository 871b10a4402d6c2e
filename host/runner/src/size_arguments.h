#pragma once

#include <string>
#include <vector>

#include <tether/runner/trial.h>
#include <tether/scenario/shipped_files.h>

namespace tether::runner {

/// As in campaign::ThisRun: with which `tether size` flies what this trial flew. A shipped scenario
/// goes by its name. Empty if it cannot: with replaced values, a SUT that the user starts, or a
/// computer whose time it cannot stretch.
std::vector<std::string> size_arguments(const TrialSpec& spec,
                                        const scenario::ShippedFiles& shipped);

}  // namespace tether::runner
