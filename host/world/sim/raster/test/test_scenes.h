#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tether/sim_raster/renderer.h>
#include <tether/sim_raster/scene.h>

/// Scenes and pictures for this library's tests. The camera stands at W's origin unless a test
/// moves it: W's x is right in the picture, y down, z ahead.
namespace tether::raster {

/// A number of [low, high) that depends on the key only.
double drawn(std::uint64_t seed, std::uint64_t index, double low, double high);

/// A rectangle at depth `z`, seen from the origin, upright: u runs right, v runs down.
Mesh rectangle(float left, float top, float right, float bottom, float z, float repeat = 1.0F);
/// A box around its origin whose normals are those of its faces.
Mesh box(float size);
/// A ball of as many triangles as 2·n².
Mesh ball(float radius, int n);
/// A grid of n × n squares at about depth `z`, all of it seen, with corners moved at random.
Mesh crumpled_sheet(std::uint64_t seed, int n, float z);
/// A texture of random pixels.
Texture noise(std::uint64_t seed, int width_px, int height_px);

/// A scene in which a mesh is lit by ambient light only, white, so that colours are those of the
/// material.
SceneParts plain_parts(Mesh mesh, const Rgb& colour);

/// Many things at once: textures, lights of all kinds, transparency, a body that moves, shadows.
SceneParts rich_parts();

/// A picture and what it is drawn into.
struct Drawing {
  int width_px;
  std::vector<std::uint8_t> rgb;
  std::vector<float> depth_m;
  std::vector<std::uint32_t> entity;

  std::vector<int> at(int column, int row) const;
};
/// With all that a picture can hold.
Drawing draw(Renderer& renderer, const View& view);
/// A picture of one instant from `X_WC`.
Drawing draw(const Scene& scene, const uav::CameraModel& camera, const uav::Pose& X_WC = {});

std::uint64_t hash_of(const Drawing& drawing);

uav::CameraModel small_camera(int width_px = 160, int height_px = 120);
/// The same with barrel distortion.
uav::CameraModel bent_camera(int width_px = 160, int height_px = 120);

}  // namespace tether::raster
