#pragma once

#include <string>

#include <tether/sim/world.h>

namespace tether::sim {

/// An external simulator that reads the world's SDF files itself, and the latest SDF version that
/// it reads.
struct SdfReader {
  std::string name;  ///< "Gazebo 11"
  int major = 1;
  int minor = 7;
};

/// @throws Error(kBadFile) with file and line for the first of the world's `sdf_files` with a later
/// version than the reader's, or with a shape that the reader's version lacks: <capsule> and
/// <ellipsoid> were introduced in SDF 1.8.
void check_sdf_version(const World& world, const SdfReader& reader);

}  // namespace tether::sim
