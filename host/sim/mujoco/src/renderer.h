#pragma once

#include <memory>
#include <vector>

#include <tether/sim_raster/renderer.h>
#include <tether/sim_raster/scene.h>
#include <tether/sim_sensing/view_renderer.h>

namespace tether::sim {

/// Draws views of a scene in software: the same bytes on every machine. One thread at a time.
class Renderer final : public ViewRenderer {
 public:
  /// `bodies`: how many bodies of the world move.
  Renderer(std::shared_ptr<const raster::Scene> scene);

  void render(const View& view, std::span<std::uint8_t> rgb) override;
  double nearest_depth_m() override;
  std::string name() const override { return "software renderer"; }

 private:
  std::shared_ptr<const raster::Scene> scene_;
  raster::Renderer renderer_;
  std::vector<float> depth_m_;  ///< of the last view; empty if it was without
  double far_m_ = 0.0;
};

}  // namespace tether::sim
