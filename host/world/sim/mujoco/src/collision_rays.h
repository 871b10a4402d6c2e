#pragma once

#include "engine.h"
#include "physics_model.h"

#include <vector>

#include <tether/sim_sensing/sensor_suite.h>

namespace tether::sim {

/// Casts rays at the collision shapes of a physics model.
class CollisionRays final : public RayCaster {
 public:
  /// `model` as `make_physics_model` makes it of the world; must outlive this object.
  CollisionRays(const mjModel& model, const World& world);

  void cast(const RayBundle& bundle, std::span<double> distances_m) override;
  bool cast_with_intensities(const RayBundle& bundle, std::span<double> distances_m,
                             std::span<float> intensities) override;

 private:
  const mjModel& model_;
  std::vector<Shape> shapes_;
  DataPtr data_;
};

}  // namespace tether::sim
