#pragma once

#include "image_warp.h"
#include "light_mix.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <tether/sim_sensing/view_renderer.h>

namespace tether::sim {

/// As `make_composite_renderer` says.
class CompositeRenderer final : public CameraRenderer {
 public:
  CompositeRenderer(std::unique_ptr<ViewRenderer> views, std::vector<double> body_radii_m);

  void draw(const raster::View& view, const raster::Picture& picture) override;
  std::size_t blind_pixels(const uav::CameraModel& camera) override;
  std::string name() const override { return views_->name(); }

 private:
  using Bytes = std::span<std::uint8_t>;
  // Some rows of a picture that lie one below the other.
  struct Rows {
    int first;
    int count;
  };

  const ImageWarp* warp_of(const uav::CameraModel& camera);
  void draw_instant(const raster::View& view, double before_end_s, const Rows& rows, Bytes rgb);
  void mix(const raster::View& view, int instants, Bytes rgb);
  void add_rows(const raster::View& view, int instant, int instants, Bytes rgb);

  std::unique_ptr<ViewRenderer> views_;
  std::vector<double> body_radii_m_;
  std::vector<std::pair<uav::CameraModel, ImageWarp>> warps_;
  raster::Moment moment_;
  std::vector<std::uint8_t> ideal_rgb_;
  std::vector<std::uint8_t> instant_rgb_;
  LightMix light_;
};

}  // namespace tether::sim
