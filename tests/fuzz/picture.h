#pragma once

#include "fuzz_target.h"

#include <cmath>
#include <utility>
#include <vector>

#include <tether/sim_raster/renderer.h>
#include <tether/sim_raster/scene.h>

namespace tether::fuzz {

/// Draws a small picture of a scene that was accepted, from two metres behind its first visual's
/// origin.
inline void draw(const raster::SceneParts& parts) {
  const raster::Scene scene(parts);
  raster::Renderer renderer(scene);
  const std::vector<uav::Pose> bodies(scene.bodies());
  const raster::Instant instant{
      uav::Pose{{-2.0, 0.0, 0.0}, {}} * uav::Pose{{}, uav::q_body_from_optical()}, bodies};
  raster::View view;
  view.camera = uav::CameraModel::from_horizontal_fov(32, 24, 1.4);
  view.instants = {&instant, 1};
  std::vector<std::uint8_t> rgb(std::size_t{3} * 32 * 24);
  std::vector<float> depth_m(std::size_t{32} * 24);
  raster::Picture picture;
  picture.rgb = rgb;
  picture.depth_m = depth_m;
  renderer.draw(view, picture);
  for (const float d : depth_m) require(d > 0.0F, "a depth that is no distance");
}

}  // namespace tether::fuzz
