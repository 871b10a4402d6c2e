#pragma once

#include "dynamics.h"
#include "image_motion.h"
#include "image_warp.h"
#include "light_mix.h"
#include "renderer.h"
#include "sensors.h"
#include "shutter.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tether/sim/world.h>
#include <tether/uav/samples.h>

namespace tether::sim {

/// Makes the images of a world's cameras: draws what the lens sees at each instant that the shutter
/// needs, mixes the rows, adds the pixels' noise.
class ImageMaker {
 public:
  /// `world` and `dynamics` must outlive this object. Names through `warn` what cannot be shown,
  /// some of it when the first image is made.
  ImageMaker(const World& world, const Dynamics& dynamics, const WarningSink& warn);

  /// What a camera of the world sees, and when.
  struct Request {
    const std::vector<double>& state;  ///< as Dynamics captured it
    std::size_t uav;
    const Sensor& sensor;
    const MeasurementKey& key;
  };
  uav::CameraSample make(const CameraModel& camera, const Request& request);

  /// OpenGL's name of the renderer; empty before the first image.
  std::string renderer_name() const { return renderer_ ? renderer_->name() : std::string(); }

 private:
  // One camera: what must be rendered for it, and how its image comes out of that.
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
  Renderer& renderer();
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
  const Dynamics& dynamics_;
  WarningSink warn_;
  Scene scene_;  // until the renderer takes it
  std::vector<double> body_radii_m_;
  std::map<const Sensor*, Plan> plans_;
  std::optional<Renderer> renderer_;
  std::vector<uav::Pose> poses_;
  LightMix light_;
  std::vector<std::uint8_t> instant_rgb_;
};

}  // namespace tether::sim
