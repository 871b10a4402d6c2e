#pragma once

#include <cstdint>

#include <tether/record/reader.h>

namespace tether::audit {

/// What kind of run to make up.
struct GeneratorOptions {
  std::uint64_t seed = 1;
  int suts = 3;
  int interactions_per_sut = 200;
  Duration step{1'000'000};
  bool wall_times = true;
  SimTime stop_at = SimTime::max();  ///< ends at this ST (a boundary) as at a time limit
};

/// A record that keeps every rule by construction: each SUT's timestamps are drawn first (they do
/// not depend on the others), then everything is put in the order in which a barrier lets it
/// happen.
record::Record generate(const GeneratorOptions& options);

}  // namespace tether::audit
