#pragma once

#include <cstdint>
#include <vector>

#include <tether/sim/simulator.h>
#include <tether/sim/world.h>

/// A flight that shows whether a back end is deterministic.
namespace tether::sim::testing {

/// The measurements at one instant of a run.
struct Observation {
  std::vector<double> numbers;
  std::vector<std::uint8_t> image;
  friend bool operator==(const Observation&, const Observation&) = default;
};

/// A world in which everything is noisy and blurred, and two UAVs fly past a loose box.
World busy_world();
/// The measurements of both UAVs of `busy_world` of a snapshot.
Observation observe(Simulator& simulator, const Snapshot& snapshot, std::uint64_t index);
/// Flies 0.5 s of `busy_world`, and observes the end.
Observation fly_in_one_piece(Simulator& simulator, std::uint64_t seed);
/// The same with other measurements in between, with the advance in uneven pieces, and with the
/// observation long after its instant.
Observation fly_in_pieces(Simulator& simulator, std::uint64_t seed);

}  // namespace tether::sim::testing
