#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <tether/sim/simulator.h>
#include <tether/sim/world.h>
#include <tether/sim_sensing/camera_renderer.h>
#include <tether/sim_sensing/ray_caster.h>
#include <tether/sim_sensing/state_layout.h>
#include <tether/uav/samples.h>

namespace tether::sim {

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
