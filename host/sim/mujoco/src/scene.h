#pragma once

#include "engine.h"
#include "triangle_mesh.h"

#include <filesystem>
#include <optional>
#include <vector>

#include <mujoco/mujoco.h>

#include <tether/sim/bodies.h>

namespace tether::sim {

/// The engine's display list of mesh i; the next one is for the mesh's hull.
constexpr int mesh_list(std::size_t mesh) {
  return 2 * static_cast<int>(mesh);
}

/// One visual, ready for the renderer. `geom.dataid` is the `mesh_list` of one of the scene's
/// meshes, `geom.texid` one of its textures.
struct SceneItem {
  mjvGeom geom;
  std::optional<std::size_t> body;  ///< of `moving_bodies`; none: fixed, and the pose is in W
  uav::Pose X_BV;
  BoundingSphere bounds;  ///< in V
};

/// The world as the renderer needs it: the visuals only.
struct Scene {
  std::vector<SceneItem> items;
  std::vector<TriangleMesh> meshes;
  std::vector<std::filesystem::path> textures;
  std::vector<mjvLight> lights;
  uav::Vec3 background_rgb;
  bool shadows = false;
};

/// Warns of what the renderer cannot show: coloured specular light, an ambient colour that differs
/// from the diffuse one, lights beyond the eighth (ambient light counts as one), textures beyond
/// the 99th or that are not PNG files, visuals without a shadow if others have one.
/// @throws Error(kBadFile) for a mesh or texture that cannot be read.
Scene make_scene(const World& world, const WarningSink& warn);

/// The drawn extent of each of `bodies` moving bodies from its origin [m].
std::vector<double> body_radii_m(const Scene& scene, std::size_t bodies);

/// The renderer's assets (textures, and one list per mesh to be filled by the renderer) as an
/// engine model.
ModelPtr make_scene_model(const Scene& scene, int width_px, int height_px);

}  // namespace tether::sim
