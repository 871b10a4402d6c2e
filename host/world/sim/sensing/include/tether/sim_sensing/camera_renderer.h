#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include <tether/sim_raster/renderer.h>
#include <tether/sim_raster/view.h>
#include <tether/uav/camera_model.h>

namespace tether::sim {

/// Draws the pictures of cameras: what a back end provides for them. Lens, exposure and rolling
/// shutter are part of a picture; the sensing library adds the noise. The same view always gives
/// the same bytes. One thread at a time.
class CameraRenderer {
 public:
  virtual ~CameraRenderer() = default;
  CameraRenderer(const CameraRenderer&) = delete;
  CameraRenderer& operator=(const CameraRenderer&) = delete;

  /// `view.instants` have the poses of all of `moving_bodies`, in its order,
  /// then those of `turned_parts`; `view.hidden` is one
  /// of these. A pixel's entity is the number of its model, as in `model_names`.
  /// @throws Error(kSetup) when the back end is lost.
  virtual void draw(const raster::View& view, const raster::Picture& picture) = 0;

  /// Whether it draws depths and entities, too. If not, cameras measure colours only.
  virtual bool knows_pixels() const { return false; }

  /// How many pixels of a camera are black, because its distortion maps no direction to them.
  virtual std::size_t blind_pixels(const uav::CameraModel& camera) = 0;

  /// The renderer's name, for the record; maybe empty before the first picture.
  virtual std::string name() const = 0;

 protected:
  CameraRenderer() = default;
};

/// Called once, for the first image: a run without a camera needs no renderer. Helpers may be null;
/// else they outlive the renderer's pictures.
/// @throws Error(kSetup) without a renderer, Error(kBadFile) for something that cannot be shown.
using CameraRendererFactory =
    std::function<std::unique_ptr<CameraRenderer>(raster::Helpers* helpers)>;

}  // namespace tether::sim
