#pragma once

#include "image_motion.h"
#include "image_warp.h"
#include "light_mix.h"
#include "sensors.h"
#include "shutter.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tether/sim/world.h>
#include <tether/sim_sensing/state_layout.h>
#include <tether/sim_sensing/view_renderer.h>
#include <tether/uav/samples.h>

namespace tether::sim {

/// Makes the images of a world's cameras: draws the view at each instant that the shutter needs,
/// applies the lens, mixes the rows, and adds the pixel noise.
class ImageMaker {
 public:
  /// `world` must outlive this object. `body_radii_m` and `make_renderer` as in
  /// SensorSuite::BackEnd. Warns of what cannot be shown when an image is made.
  ImageMaker(const World& world, std::vector<double> body_radii_m,
             ViewRendererFactory make_renderer, const WarningSink& warn);

  /// The ideal camera whose view is drawn for `camera`.
  static uav::CameraModel rendered_camera(const uav::CameraModel& camera);

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
  // One camera: the view to be rendered, and how its image is made from that.
  struct Plan {
    uav::CameraModel rendered;
    std::optional<ImageWarp> warp;

    explicit Plan(const uav::CameraModel& camera);
  };
  using Bytes = std::span<std::uint8_t>;
  // Some rows of an image that lie one below the other.
  struct Rows {
    int first;
    int count;
  };

  const Plan& plan_of(const Sensor& sensor, const CameraModel& camera);
  ViewRenderer& renderer();
  void draw(const CameraModel& camera, const Request& r, double steps_ago, const Rows& rows,
            Bytes rgb);
  double motion_px(const CameraModel& camera, const Request& r);
  double step_motion_px(const CameraModel& camera, const Request& r, double steps_ago,
                        double nearest_m);
  void mix(const CameraModel& camera, const Request& r, int instants, Bytes rgb);
  Rows exposed_rows(const CameraModel& camera, const Request& r, int instant, int instants);
  void add_rows(const Shutter& shutter, int instant, int instants, Bytes rgb);
  double steps_of(double seconds) const { return seconds / to_seconds(world_.step); }
  Movement movement_of(const Request& r, std::size_t body, double steps_ago) const;

  const World& world_;
  StateLayout layout_;
  std::vector<double> body_radii_m_;
  ViewRendererFactory make_renderer_;
  WarningSink warn_;
  std::map<const Sensor*, Plan> plans_;
  std::unique_ptr<ViewRenderer> renderer_;
  std::vector<uav::Pose> poses_;
  std::vector<std::uint8_t> ideal_rgb_;
  LightMix light_;
  std::vector<std::uint8_t> instant_rgb_;
};

}  // namespace tether::sim
