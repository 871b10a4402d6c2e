#pragma once

#include <memory>

#include <tether/sim/simulator.h>

namespace tether::sim {

/// Whether this build contains the embedded back end.
extern const bool kHasMujoco;

/// The embedded simulator: MuJoCo for dynamics, `sim/raster` for cameras. Its images have the same
/// bytes on every machine.
/// Used from one thread at a time, any thread.
///
/// A UAV's cameras and rays do not see its own body. Rays meet collision shapes, cameras see
/// visuals. A mesh collides as its convex hull. Each pixel is drawn along its own ray, at the time
/// of its row's exposure. The walking bias of a sensor is a function of seed and ST alone.
/// `description()` includes the renderer after the first image.
///
/// Expected pictures are drawn on `threads_ahead` threads of its own; 0: `expect` does nothing.
///
/// `warn` receives one line for each thing of the world that MuJoCo cannot represent.
/// @throws Error(kSetup) when the back end is not built in or the model does not compile.
std::unique_ptr<Simulator> make_mujoco_simulator(World world, const WarningSink& warn,
                                                 int threads_ahead = 0);

}  // namespace tether::sim
