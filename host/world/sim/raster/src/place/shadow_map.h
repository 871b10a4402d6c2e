#pragma once

#include "place/layer.h"
#include "place/lens.h"
#include "place/rasterize.h"
#include "scene/prepared_scene.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include <tether/uav/math.h>

namespace tether::raster {

/// The picture of a scene's shadow casters as a light sees them: for each direction, the reciprocal
/// of the depth at which the light ends. Fixed casters and those of bodies have a picture each, as
/// large as they need: the shadow of a small UAV is sharp in a large world too.
class ShadowMap {
 public:
  static constexpr int kSize_px = 2048;
  enum class Casters { kFixed, kBodies };

  /// Draws the casters if they are fixed; those of bodies need `update` first.
  ShadowMap(const PreparedScene& scene, const Light& light, Casters casters);

  /// Draws the visuals of bodies at these poses. Does nothing if the casters are fixed.
  void update(std::span<const uav::Pose> X_WB, std::optional<std::size_t> hidden);

  /// From W to the light's picture: rows of u·z, v·z and z, of which u and v are in pixels.
  std::array<double, 12> from_world() const;
  /// Row by row.
  const float* inverse_depth() const { return map_.data(); }
  /// A surface is looked up this far along its normal, per depth, so that none shadows itself at
  /// any angle of the light: further than the pixels of the light's picture that are looked at.
  float offset_per_depth() const {
    return std::max(kOffset_px / static_cast<float>(layer_.projection.fx), kDepthError);
  }

 private:
  static constexpr float kOffset_px = 2.0F;
  static constexpr float kDepthError = 5e-7F;  ///< of single precision, several roundings

  void aim_at(const Sphere& casters);
  void draw(std::optional<std::size_t> hidden);
  void draw_tile(std::size_t index);

  const PreparedScene& scene_;
  const Light& light_;
  Casters casters_;
  double fixed_radius_m_;
  Lens lens_;
  Layer layer_;
  std::vector<float> map_;
  std::vector<std::size_t> drawn_tiles_;
  TileIds ids_;
};

}  // namespace tether::raster
