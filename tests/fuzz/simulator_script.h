#pragma once

#include <tether/sim/simulator.h>
#include <tether/sim/world.h>

/// What the host asks of a simulator outside in the target `simulator_host`, and in the writing of
/// its seeds.
namespace tether::fuzz {

/// One UAV with a camera, an IMU and a rangefinder before a box that moves.
sim::World scripted_world();
/// Requests of every kind, the same each time.
void fly_script(sim::Simulator& simulator);

}  // namespace tether::fuzz
