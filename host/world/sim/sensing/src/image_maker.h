#pragma once

#include "sensors/measurement.h"

#include <cstddef>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <tether/sim/world.h>
#include <tether/sim_sensing/sensor_suite.h>
#include <tether/sim_sensing/state_layout.h>
#include <tether/uav/samples.h>

namespace tether::sim {

/// Makes the images of a world's cameras: has them drawn with the poses of the steps that the
/// shutter reaches back, and adds the noise.
class ImageMaker {
 public:
  /// `world` must outlive this object. Warns of what cannot be shown when an image is made. The
  /// renderer gets `helpers`, which may be null.
  ImageMaker(const World& world, CameraRendererFactory make_renderer, raster::Helpers* helpers,
             const WarningSink& warn);

  /// Which camera of the world makes which image.
  struct Request {
    const std::vector<double>& state;  ///< as StateRecorder captured it
    std::size_t uav;
    const Sensor& sensor;
    const MeasurementKey& key;
  };
  uav::CameraSample make(const CameraModel& camera, const Request& request);

  /// The renderer's name; empty before the first image.
  std::string renderer_name() const { return renderer_ ? renderer_->name() : std::string(); }

 private:
  void draw(const CameraModel& camera, const Request& r, raster::Picture picture);
  void place_instants(const CameraModel& camera, const Request& r);
  void warn_of_blind_pixels(const CameraModel& camera, const Sensor& sensor);
  CameraRenderer& renderer();

  const World& world_;
  StateLayout layout_;
  std::vector<TurnedPart> parts_;
  CameraRendererFactory make_renderer_;
  raster::Helpers* helpers_;
  WarningSink warn_;
  std::unique_ptr<CameraRenderer> renderer_;
  std::set<const Sensor*> checked_;
  std::vector<uav::Pose> poses_;  ///< of all bodies, at one instant after the other
  std::vector<raster::Instant> instants_;
  std::vector<std::uint32_t> models_;  ///< which each pixel shows
};

}  // namespace tether::sim
