#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <tether/sim_sensing/sensor_suite.h>

/// A back end that makes everything up, and remembers what it was asked for.
namespace tether::sim::testing {

/// What the renderers of `fake_renderers` were asked for, and what they answer.
struct DrawLog {
  /// A view with copies of its poses.
  struct Drawn {
    raster::View view;
    bool has_rgb = false, has_depth = false, has_models = false;  ///< what was asked for
    std::vector<uav::Pose> X_WC;
    std::vector<std::vector<uav::Pose>> X_WB;
  };
  int made = 0;
  std::vector<Drawn> drawn;

  std::uint8_t grey = 0;  ///< of each pixel
  float depth_m = 0.0F;
  std::uint32_t model = 0;
  bool knows_pixels = false;
  std::size_t blind_pixels = 0;
};

/// Renderers named "fake"; `log` must outlive them.
CameraRendererFactory fake_renderers(DrawLog& log);

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
