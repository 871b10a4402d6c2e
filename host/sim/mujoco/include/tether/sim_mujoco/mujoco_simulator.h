#pragma once

#include <memory>

#include <tether/sim/simulator.h>

namespace tether::sim {

/// Whether this build contains the embedded back end.
extern const bool kHasMujoco;

/// The embedded simulator: MuJoCo for dynamics, its renderer on a headless EGL display for cameras
/// (created when the first image is asked for, so that a run without a camera needs no GL at all).
/// Used from one thread at a time, any thread.
///
/// What it does beside the world's words: a UAV's own body is not drawn for its own cameras and not
/// met by its own rays; rays meet collision shapes, cameras see visuals; a mesh collides as its
/// convex hull; a lens's distortion and oblong pixels are resampled from an ideal picture; the
/// walking bias of a sensor is a function of seed and ST alone. `description()` names the OpenGL
/// renderer after the first image.
///
/// `warn` receives one line for each thing of the world that MuJoCo cannot represent.
/// @throws Error(kSetup) when the back end is not built in or the model does not compile.
std::unique_ptr<Simulator> make_mujoco_simulator(World world, const WarningSink& warn);

}  // namespace tether::sim
