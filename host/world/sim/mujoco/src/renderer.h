#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include <tether/sim_raster/renderer.h>
#include <tether/sim_raster/scene.h>
#include <tether/sim_sensing/sensor_suite.h>

namespace tether::sim {

/// Draws pictures of a scene in software: the same bytes on every machine. One thread at a time.
class Renderer final : public CameraRenderer {
 public:
  explicit Renderer(std::shared_ptr<const raster::Scene> scene, raster::Helpers* helpers = nullptr)
      : scene_(std::move(scene)), renderer_(*scene_, helpers) {}

  void draw(const raster::View& view, const raster::Picture& picture) override {
    renderer_.draw(view, picture);
  }
  bool knows_pixels() const override { return true; }
  std::size_t blind_pixels(const uav::CameraModel& camera) override {
    return renderer_.blind_pixels(camera);
  }
  std::string name() const override { return "software renderer"; }

 private:
  std::shared_ptr<const raster::Scene> scene_;  ///< other renderers may draw it, too
  raster::Renderer renderer_;
};

}  // namespace tether::sim
