#pragma once

#include <string>

#include <tether/sim/world.h>

namespace tether::sim {

/// A simulator that reads the world's SDF files itself, and the latest SDF that it knows.
struct SdfReader {
  std::string name;  ///< "Gazebo 11"
  int major = 1;
  int minor = 7;
};

/// @throws Error(kBadFile) with file and line for the first of the world's `sdf_files` whose
/// version is later than the reader's, or that has a shape that its version does not: <capsule> and
/// <ellipsoid> came with SDF 1.8.
void check_sdf_version(const World& world, const SdfReader& reader);

}  // namespace tether::sim
