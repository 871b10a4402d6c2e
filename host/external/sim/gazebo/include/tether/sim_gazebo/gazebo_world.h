#pragma once

#include <tether/sim/world.h>

namespace tether::sim {

/// For a world that Gazebo 11 reads itself. @throws Error(kBadFile) with file, line and element for
/// the first element of its `sdf_files` that Gazebo reads differently from load_world, or that
/// violates a rule of time: a mesh or an <include> by a relative path, an <actor>, physics other
/// than ODE. The content of plugins is not checked.
void check_gazebo_world(const World& world);

}  // namespace tether::sim
