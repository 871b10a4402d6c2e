#pragma once

#include "layer.h"
#include "lens.h"
#include "prepared_scene.h"
#include "rasterize.h"

#include <array>
#include <optional>
#include <vector>

#include <tether/uav/math.h>

namespace tether::raster {

/// The picture of a scene's shadow casters as a light sees them: for each direction, the reciprocal
/// of the depth at which the light ends.
class ShadowMap {
 public:
  static constexpr int kSize_px = 2048;

  ShadowMap(const PreparedScene& scene, const Light& light);

  /// Draws the visuals of bodies at these poses.
  void update(std::span<const uav::Pose> X_WB, std::optional<std::size_t> hidden);

  /// From W to the light's picture: rows of u·z, v·z and z, of which u and v are in pixels.
  std::array<double, 12> from_world() const;
  /// Row by row.
  const float* inverse_depth() const { return now_.data(); }
  /// A surface is looked up this far along its normal, per depth, so that none shadows itself at
  /// any angle of the light: further than the pixels of the light's picture that are looked at.
  float offset_per_depth() const { return kOffset_px / static_cast<float>(layer_.projection.fx); }

 private:
  static constexpr float kOffset_px = 2.0F;

  void draw(const Selection& selection, std::vector<float>& map);
  void draw_tile(std::size_t index, std::vector<float>& map);
  void copy_tile(std::size_t index);

  const PreparedScene& scene_;
  Lens lens_;
  Layer layer_;
  std::vector<float> fixed_;
  std::vector<float> now_;
  std::vector<std::size_t> drawn_tiles_;  ///< that hold visuals of bodies
  TileIds ids_;
};

}  // namespace tether::raster
