#pragma once

#include <string>

#include <tether/record/reader.h>

namespace tether::record {

struct CanonicalOptions {
  /// Include what depends on the speed of the simulator relative to the SUT: the ST at which a
  /// request, an annotation or a stop arrived, and the lag. These are equal only for two runs of a
  /// scripted SUT that sends no progress messages.
  bool arrivals = false;
};

/// A run as text, for comparison: a line per interaction, command, ground truth, annotation, stop
/// and image (its checksum), then the end of the run. Grouped by topic and UAV, each in file order.
/// Two runs that differ only in wall time give the same text. The text has no header, no wall times
/// and, by default, no arrivals.
std::string canonical(const Record& record, const CanonicalOptions& options = {});

}  // namespace tether::record
