#pragma once

#include <string>

#include <tether/record/reader.h>

namespace tether::record {

struct CanonicalOptions {
  /// Also what depends on how fast the simulator ran beside the SUT: ST when a request, an
  /// annotation or a stop arrived, and the lag. Two runs of one scripted SUT that sends no progress
  /// agree even in these.
  bool arrivals = false;
};

/// What a run was, as text: a line per interaction, command, ground truth, annotation, stop and
/// image (its checksum), then how it ended. Grouped by topic and UAV, each in file order. Two runs
/// that differ only in wall time give the same text. Header, wall times and, unless asked for,
/// arrivals are left out.
std::string canonical(const Record& record, const CanonicalOptions& options = {});

}  // namespace tether::record
