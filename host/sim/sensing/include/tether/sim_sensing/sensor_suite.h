#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <tether/sim/simulator.h>
#include <tether/sim/world.h>
#include <tether/sim_sensing/camera_renderer.h>
#include <tether/sim_sensing/ray_caster.h>
#include <tether/sim_sensing/state_layout.h>
#include <tether/uav/samples.h>

namespace tether::sim {

class ImageMaker;

/// All sensors of a world: makes the samples of `Simulator::measure` from captured states, rays and
/// pictures. Mounting, lever arms, noise, limits and dropouts are the same for every back end. One
/// thread at a time.
class SensorSuite {
 public:
  struct BackEnd {
    RayCaster& rays;  ///< must outlive the suite
    CameraRendererFactory make_renderer;
  };

  /// `world` must outlive the suite. Warns of what a camera cannot show when its first image is
  /// made. @throws Error(kBadFile) as `shutter_steps` does.
  SensorSuite(const World& world, BackEnd back_end, const WarningSink& warn);
  ~SensorSuite();
  SensorSuite(const SensorSuite&) = delete;
  SensorSuite& operator=(const SensorSuite&) = delete;

  /// `seed` keys all noise from here on; it is 0 before.
  void reset(std::uint64_t seed) { seed_ = seed; }

  /// As `Simulator::measure`. @pre the snapshot's state is as StateRecorder captures it.
  /// @throws Error(kInternal) for a UAV or sensor that the world does not have; what the back end
  /// throws.
  uav::Sample measure(const Snapshot& snapshot, std::size_t uav, std::size_t sensor,
                      std::uint64_t index);

  /// The renderer's name; empty before the first image.
  std::string renderer_name() const;

 private:
  void cast(const RangeModel& range, const std::vector<double>& state, std::size_t uav,
            const uav::Pose& X_BS);

  const World& world_;
  StateLayout layout_;
  RayCaster& rays_;
  std::unique_ptr<ImageMaker> images_;
  std::uint64_t seed_ = 0;
  std::vector<uav::Pose> X_WB_;
  std::vector<double> distances_m_;
};

}  // namespace tether::sim
