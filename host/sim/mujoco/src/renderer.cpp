#include "renderer.h"

#include <algorithm>

namespace tether::sim {

Renderer::Renderer(std::shared_ptr<const raster::Scene> scene)
    : scene_(std::move(scene)), renderer_(*scene_) {}

void Renderer::render(const View& view, std::span<std::uint8_t> rgb) {
  const raster::Instant instant{view.X_WS * uav::Pose{{}, uav::q_body_from_optical()}, view.X_WB};
  depth_m_.resize(view.with_depth ? rgb.size() / 3 : 0);
  far_m_ = view.far_m;
  raster::View drawn;
  drawn.camera = view.camera;
  drawn.near_m = view.near_m;
  drawn.far_m = view.far_m;
  drawn.instants = {&instant, 1};
  drawn.hidden = view.hidden;
  raster::Picture picture;
  picture.rgb = rgb;
  picture.depth_m = depth_m_;
  renderer_.draw(drawn, picture);
}

double Renderer::nearest_depth_m() {
  const auto nearest = std::min_element(depth_m_.begin(), depth_m_.end());
  return nearest == depth_m_.end() ? far_m_ : std::min(far_m_, static_cast<double>(*nearest));
}

}  // namespace tether::sim
