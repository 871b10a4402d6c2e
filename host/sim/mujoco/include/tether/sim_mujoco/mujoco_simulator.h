#pragma once

#include <memory>

#include <tether/sim/simulator.h>

namespace tether::sim {

/// Whether this build contains the embedded back end.
extern const bool kHasMujoco;

/// The embedded simulator: MuJoCo for dynamics, its renderer on a headless EGL display for cameras
/// (created for the first image, so that a run without a camera needs no GL).
/// Used from one thread at a time, any thread.
///
/// A UAV's cameras and rays do not see its own body. Rays meet collision shapes, cameras see
/// visuals. A mesh collides as its convex hull. Distortion and oblong pixels are resampled from an
/// ideal picture. The walking bias of a sensor is a function of seed and ST alone. `description()`
/// includes the OpenGL renderer after the first image.
///
/// Expected pictures are drawn on `threads_ahead` threads of its own; 0: `expect` does nothing.
///
/// `warn` receives one line for each thing of the world that MuJoCo cannot represent.
/// @throws Error(kSetup) when the back end is not built in or the model does not compile.
std::unique_ptr<Simulator> make_mujoco_simulator(World world, const WarningSink& warn,
                                                 int threads_ahead = 0);

}  // namespace tether::sim
