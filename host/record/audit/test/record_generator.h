#pragma once

#include <cstdint>

#include <tether/record/reader.h>

namespace tether::audit {

/// A run to generate.
struct GeneratorOptions {
  std::uint64_t seed = 1;
  int suts = 3;
  int interactions_per_sut = 200;
  Duration step{1'000'000};
  bool wall_times = true;
  SimTime stop_at = SimTime::max();  ///< time limit: the run ends at this ST (a boundary)
};

/// A record that keeps every rule by construction: each SUT's timestamps are drawn first (they do
/// not depend on the others), then all events are sorted into the order that a barrier allows.
record::Record generate(const GeneratorOptions& options);

}  // namespace tether::audit
