#pragma once

#include <tether/sim/world.h>

namespace tether::sim {

/// For a world that Gazebo 11 reads itself. @throws Error(kBadFile) with file and line for the
/// first thing in its `sdf_files` that load_world reads otherwise, or that breaks a rule of time:
/// a mesh or an <include> by a relative path, an <actor>, physics other than ODE. What is in
/// plugins is theirs.
void check_gazebo_world(const World& world);

}  // namespace tether::sim
