#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <tether/sim/simulator.h>
#include <tether/sim/world.h>
#include <tether/sim_raster/renderer.h>
#include <tether/sim_sensing/state_layout.h>
#include <tether/uav/camera_model.h>
#include <tether/uav/math.h>
#include <tether/uav/samples.h>

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

/// Rays from one point into the world, with the moving bodies at given poses.
struct RayBundle {
  uav::Pose X_WS;                     ///< of the sensor; the rays begin at its origin
  std::span<const uav::Vec3> rays_S;  ///< unit vectors
  std::span<const uav::Pose> X_WB;    ///< of each of `moving_bodies`, in its order
  std::size_t ignored = 0;            ///< one of `moving_bodies` that rays do not hit: the carrier
  double max_m = std::numeric_limits<double>::infinity();  ///< farther objects may be ignored
};

/// Measures distances to collision shapes: what a back end provides for rangefinders. A function of
/// its arguments: the same bundle gives the same distances. Used from one thread at a time.
class RayCaster {
 public:
  virtual ~RayCaster() = default;
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /// How far each ray goes until it meets something; infinite where it meets nothing [m].
  /// @pre as many distances as rays. @throws Error(kSetup) when the back end is lost.
  virtual void cast(const RayBundle& bundle, std::span<double> distances_m) = 0;
  /// The same with the Collision::intensity of what each ray meets, 0 of nothing. False: not known,
  /// and nothing was cast.
  virtual bool cast_with_intensities(const RayBundle& /*bundle*/, std::span<double> /*distances_m*/,
                                     std::span<float> /*intensities*/) {
    return false;
  }

 protected:
  RayCaster() = default;
};

class AheadDrawer;
class ImageMaker;

/// All sensors of a world: makes the samples of `Simulator::measure` from captured states, rays and
/// pictures. Mounting, lever arms, noise, limits and dropouts are the same for every back end. Used
/// from one thread at a time; pictures that are expected are drawn on others.
class SensorSuite {
 public:
  struct BackEnd {
    RayCaster& rays;  ///< must outlive the suite
    CameraRendererFactory make_renderer;
    /// Threads that draw expected pictures, each with a renderer of its own, which is made and used
    /// on that thread. Those that are idle help to draw the others' pictures.
    int threads_ahead = 0;
  };

  /// `world` must outlive the suite. Warns of what a camera cannot show when its first image is
  /// made. @throws Error(kBadFile) as `shutter_steps` does.
  SensorSuite(const World& world, const BackEnd& back_end, const WarningSink& warn);
  ~SensorSuite();
  SensorSuite(const SensorSuite&) = delete;
  SensorSuite& operator=(const SensorSuite&) = delete;

  /// `seed` keys all noise from here on; it is 0 before.
  void reset(std::uint64_t seed);

  /// As `Simulator::measure`. @pre the snapshot's state is as StateRecorder captures it.
  /// @throws Error(kInternal) for a UAV or sensor that the world does not have; what the back end
  /// throws.
  uav::Sample measure(const Snapshot& snapshot, std::size_t uav, std::size_t sensor,
                      std::uint64_t index);

  /// As `Simulator::expect`. Ignored for other sensors than cameras, and before the first picture
  /// of a camera, which may warn.
  void expect(const Snapshot& snapshot, std::size_t uav, std::size_t sensor, std::uint64_t index);
  /// Of pictures, since the last reset.
  SimulatorWork work() const;

  /// As `Simulator::walls_between`, as of a snapshot.
  int walls_between(const Snapshot& snapshot, std::size_t uav, std::size_t other);

  /// The renderer's name; empty before the first image.
  std::string renderer_name() const;

 private:
  const Sensor& sensor_of(std::size_t uav, std::size_t sensor) const;
  uav::Sample picture(const Snapshot& snapshot, std::size_t uav, std::size_t sensor,
                      std::uint64_t index);
  uav::Sample draw(ImageMaker& images, const Snapshot& snapshot, std::size_t uav,
                   std::size_t sensor, std::uint64_t index) const;
  void cast(const ScanModel& scan, const std::vector<double>& state, std::size_t uav,
            const Sensor& mounted);
  void cast(const RangeModel& range, const std::vector<double>& state, std::size_t uav,
            const Sensor& mounted);

  const World& world_;
  StateLayout layout_;
  RayCaster& rays_;
  std::uint64_t seed_ = 0;
  std::vector<uav::Pose> X_WB_;
  std::vector<double> distances_m_;
  std::vector<float> intensities_;                          // of the last scan; empty: not known
  std::map<const Sensor*, std::vector<uav::Vec3>> rays_S_;  // of lidars, column by column
  std::set<const Sensor*> seen_;                            // cameras with a picture
  SimulatorWork work_;                                      // on the caller's thread
  std::vector<std::unique_ptr<ImageMaker>> images_;  // one per thread; the caller's is the last
  std::unique_ptr<AheadDrawer> ahead_;               // last: its threads use the rest
};

}  // namespace tether::sim
