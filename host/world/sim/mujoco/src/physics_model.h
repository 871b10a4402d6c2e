#pragma once

#include "engine.h"
#include "meshes/mesh_file.h"

#include <string_view>
#include <vector>

#include <tether/sim/bodies.h>

namespace tether::sim {

/// Mass of a link of a driven model, and its inertia in kg m² about each axis: so much more than
/// that of a UAV that nothing pushes it.
inline constexpr double kDrivenMass_kg = 1e6;

/// The world as the physics engine needs it: the collision shapes only, with gravity and the step.
/// Static links are shapes of the engine's world body; body i of `moving_bodies` has a free joint
/// at qpos 7·i and qvel 6·i, and is the engine's body i + 1. Static shapes never meet each other.
/// @throws Error(kBadFile) where the world names a mesh that cannot be read or is flat; without a
/// place when the model does not compile.
ModelPtr make_physics_model(const World& world, const WarningSink& warn,
                            const MeshFiles& meshes = MeshFiles());

/// One of the engine's shapes.
struct Shape {
  std::string_view owner;  ///< name of the model or UAV; refers into the world
  float intensity = 0.0F;  ///< Collision::intensity
};
/// By the engine's numbers.
std::vector<Shape> shapes_of(const World& world);

/// Where body i of `moving_bodies` is in the engine's arrays.
constexpr int qpos_address(std::size_t body) {
  return static_cast<int>(body) * 7;
}
constexpr int qvel_address(std::size_t body) {
  return static_cast<int>(body) * 6;
}
constexpr int engine_body(std::size_t body) {
  return static_cast<int>(body) + 1;
}

}  // namespace tether::sim
