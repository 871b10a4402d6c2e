#include "fake_back_end.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace tether::sim::testing {
namespace {

class FakeRenderer final : public ViewRenderer {
 public:
  explicit FakeRenderer(RenderLog& log) : log_(log) {}

  void render(const View& view, std::span<std::uint8_t> rgb) override {
    log_.views.push_back({view, {view.X_WB.begin(), view.X_WB.end()}});
    EXPECT_LE(view.camera.width_px, log_.max_width_px);
    EXPECT_LE(view.camera.height_px, log_.max_height_px);
    EXPECT_EQ(rgb.size(),
              static_cast<std::size_t>(3 * view.camera.width_px * view.camera.height_px));
    std::uint8_t* out = rgb.data();
    for (int row = 0; row < view.camera.height_px; ++row) {
      for (int column = 0; column < view.camera.width_px; ++column) {
        out = std::fill_n(out, 3, log_.paint(view, column, row));
      }
    }
  }

  double nearest_depth_m() override {
    EXPECT_TRUE(log_.views.back().view.with_depth);
    ++log_.depths;
    return log_.nearest_m;
  }

  std::string name() const override { return "fake"; }

 private:
  RenderLog& log_;
};

}  // namespace

ViewRendererFactory fake_renderers(RenderLog& log) {
  return [&log](int max_width_px, int max_height_px) {
    ++log.made;
    log.max_width_px = max_width_px;
    log.max_height_px = max_height_px;
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
