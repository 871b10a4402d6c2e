#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include <tether/sim/file_cache.h>
#include <tether/sim/simulator.h>

namespace tether::sim {

/// Whether this build contains the embedded back end.
extern const bool kHasMujoco;

/// Makes the embedded simulator of a world that was read; see `make_mujoco_simulator`. Called once:
/// the simulator takes what was read.
using MakeMujocoSimulator =
    std::function<std::unique_ptr<Simulator>(const WarningSink& warn, int threads_ahead)>;

/// Reads the meshes and textures that a world names, and checks that it can be simulated. Finds the
/// textures in the cache, or keeps them there.
/// @throws Error(kBadFile) where the world names a file that cannot be used, else at its own file;
/// Error(kSetup) when the back end is not built in or memory runs out.
MakeMujocoSimulator prepare_mujoco_simulator(World world, const WarningSink& warn,
                                             const std::optional<FileCache>& cache = std::nullopt);

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
/// @throws as `prepare_mujoco_simulator`.
inline std::unique_ptr<Simulator> make_mujoco_simulator(World world, const WarningSink& warn,
                                                        int threads_ahead = 0) {
  return prepare_mujoco_simulator(std::move(world), warn)(warn, threads_ahead);
}

}  // namespace tether::sim
