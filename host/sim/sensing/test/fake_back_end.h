#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <tether/sim_sensing/ray_caster.h>
#include <tether/sim_sensing/view_renderer.h>

/// A back end that makes everything up, and remembers what it was asked for.
namespace tether::sim::testing {

/// A view with a copy of its poses.
struct SeenView {
  View view;
  std::vector<uav::Pose> X_WB;
};

/// What the renderers of `fake_renderers` do.
struct RenderLog {
  int made = 0;
  int max_width_px = 0;
  int max_height_px = 0;
  int depths = 0;  ///< how often the depth was asked for
  std::vector<SeenView> views;

  double nearest_m = 1.0;
  /// The grey of a pixel; `row` as in the picture that is drawn.
  std::function<std::uint8_t(const View& view, int column, int row)> paint =
      [](const View&, int, int) { return std::uint8_t{0}; };
};

/// Renderers named "fake" that draw as `log` says; it must outlive them.
ViewRendererFactory fake_renderers(RenderLog& log);

/// Rays that meet something at the distances given, the first ray at the first.
class FakeRays final : public RayCaster {
 public:
  /// A bundle with copies of its rays and poses.
  struct Seen {
    RayBundle bundle;
    std::vector<uav::Vec3> rays_S;
    std::vector<uav::Pose> X_WB;
  };

  explicit FakeRays(std::vector<double> distances_m) : distances_m_(std::move(distances_m)) {}
  void cast(const RayBundle& bundle, std::span<double> distances_m) override;

  std::vector<Seen> seen;

 private:
  std::vector<double> distances_m_;
};

}  // namespace tether::sim::testing
