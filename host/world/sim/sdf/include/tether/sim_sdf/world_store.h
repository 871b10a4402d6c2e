#pragma once

#include <vector>

#include <tether/sim_sdf/load_world.h>

namespace tether::sim {

/// Worlds that were read, so that trials that differ in the start poses of their UAVs read them
/// once. Not thread-safe.
class WorldStore {
 public:
  /// As load_world, with the same warnings. Does not notice that a file has changed since it was
  /// read.
  World load(const WorldRequest& request, const WarningSink& warn);

 private:
  struct Stored {
    WorldRequest request;
    World world;
    std::vector<Warning> warnings;
  };
  const Stored& find(const WorldRequest& request);

  std::vector<Stored> stored_;
};

}  // namespace tether::sim
