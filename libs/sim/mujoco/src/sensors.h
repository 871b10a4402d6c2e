#pragma once

#include "dynamics.h"
#include "engine.h"

#include <cstdint>
#include <string_view>
#include <vector>

#include <tether/base/time.h>
#include <tether/sim/world.h>
#include <tether/uav/samples.h>

namespace tether::sim {

/// Which measurement is made.
struct MeasurementKey {
  std::uint64_t seed = 0;
  std::string_view uav;
  std::string_view sensor;
  std::uint64_t index = 0;
  SimTime at;
};

/// What an IMU mounted at `X_BS` measures: rotation rate, specific force of its own point (lever
/// arm included) and attitude, the latter without error.
uav::ImuSample measure_imu(const ImuModel& imu, const uav::Pose& X_BS, const uav::Pose& X_WB,
                           const BodyMotion& motion, double gravity_m_s2,
                           const MeasurementKey& key);

/// What a rangefinder reports for the true distance [m] (infinite: nothing there): dropouts, noise,
/// resolution, limits.
uav::RangeSample measure_range(const RangeModel& range, double distance_m,
                               const MeasurementKey& key);

/// Casts rays at the collision shapes of a captured state.
class RayCaster {
 public:
  /// `dynamics` must outlive this object.
  explicit RayCaster(const Dynamics& dynamics);

  /// Distance from the origin of `X_WS` to the nearest point that any of the rays meets of a shape
  /// that is not of UAV `uav`; infinite where there is none [m].
  double cast(const std::vector<double>& state, const uav::Pose& X_WS,
              const std::vector<uav::Vec3>& rays_S, std::size_t uav);

 private:
  const Dynamics& dynamics_;
  DataPtr data_;
};

}  // namespace tether::sim
