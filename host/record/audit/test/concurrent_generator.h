#pragma once

#include <cstdint>

#include <tether/record/reader.h>

namespace tether::audit {

struct ConcurrentOptions {
  std::uint64_t seed = 1;
  int threads = 4;
  int interactions = 300;
  double wall_factor = 1.0;  ///< seconds of ET per second of the host's clock
};

/// A record of one concurrent SUT with a wall clock that keeps every rule by construction: its
/// threads send requests, all of them are stopped, the simulation catches up, and they resume.
/// Steps of 1 ms.
record::Record generate_concurrent(const ConcurrentOptions& options);

}  // namespace tether::audit
