#pragma once

#include <optional>

#include <tether/runner/trial.h>
#include <tether/scenario/shipped_files.h>

namespace tether::runner {

/// With what `tether size` flies what this trial flew. A shipped scenario goes by its name. None if
/// it cannot: with replaced values, a SUT that the user starts, or a computer whose time it cannot
/// stretch.
std::optional<campaign::Sizing> sizing_of(const TrialSpec& spec,
                                          const scenario::ShippedFiles& shipped);

}  // namespace tether::runner
