#pragma once

#include "options/common_options.h"

#include <span>
#include <string>

#include <tether/base/error.h>
#include <tether/scenario/shipped_files.h>
#include <tether/sim/world.h>

namespace tether::app {

/// The options of a command, and the shipped models.
sim::WorldOptions world_options(const ReadingOptions& reading,
                                const scenario::ShippedFiles& shipped);

/// "warning: …", without an end of line: a few warnings one line each, more of them by consequence
/// with their numbers, and `list` as the place of the whole list.
std::string summary_of(std::span<const Warning> warnings, const std::string& list);

/// "everything is simulated as written", or how many parts are not, and each of them.
std::string as_written_text(std::span<const Warning> warnings);

}  // namespace tether::app
