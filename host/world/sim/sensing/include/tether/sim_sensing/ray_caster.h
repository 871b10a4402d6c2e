#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include <tether/uav/math.h>

namespace tether::sim {

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

}  // namespace tether::sim
