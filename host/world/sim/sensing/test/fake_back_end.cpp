#include "fake_back_end.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace tether::sim::testing {
namespace {

class FakeRenderer final : public CameraRenderer {
 public:
  explicit FakeRenderer(DrawLog& log) : log_(log) {}

  void draw(const raster::View& view, const raster::Picture& picture) override {
    DrawLog::Drawn& drawn = log_.drawn.emplace_back();
    drawn.view = view;
    drawn.has_rgb = !picture.rgb.empty();
    drawn.has_depth = !picture.depth_m.empty();
    drawn.has_models = !picture.entity.empty();
    for (const raster::Instant& instant : view.instants) {
      drawn.X_WC.push_back(instant.X_WC);
      drawn.X_WB.emplace_back(instant.X_WB.begin(), instant.X_WB.end());
    }
    std::fill(picture.rgb.begin(), picture.rgb.end(), log_.grey);
    std::fill(picture.depth_m.begin(), picture.depth_m.end(), log_.depth_m);
    std::fill(picture.entity.begin(), picture.entity.end(), log_.model);
  }
  bool knows_pixels() const override { return log_.knows_pixels; }
  std::size_t blind_pixels(const uav::CameraModel&) override { return log_.blind_pixels; }
  std::string name() const override { return "fake"; }

 private:
  DrawLog& log_;
};

}  // namespace

CameraRendererFactory fake_renderers(DrawLog& log) {
  return [&log](raster::Helpers* /*helpers*/) {
    ++log.made;
    return std::make_unique<FakeRenderer>(log);
  };
}

void FakeRays::cast(const RayBundle& bundle, std::span<double> distances_m) {
  seen.push_back({bundle,
                  {bundle.rays_S.begin(), bundle.rays_S.end()},
                  {bundle.X_WB.begin(), bundle.X_WB.end()}});
  ASSERT_EQ(distances_m.size(), bundle.rays_S.size());
  ASSERT_EQ(distances_m.size(), distances_m_.size());
  std::copy(distances_m_.begin(), distances_m_.end(), distances_m.begin());
}

}  // namespace tether::sim::testing
