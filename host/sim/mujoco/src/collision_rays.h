#pragma once

#include "engine.h"

#include <tether/sim_sensing/ray_caster.h>

namespace tether::sim {

/// Casts rays at the collision shapes of a physics model.
class CollisionRays final : public RayCaster {
 public:
  /// `model` as `make_physics_model` makes it; must outlive this object.
  explicit CollisionRays(const mjModel& model);

  void cast(const RayBundle& bundle, std::span<double> distances_m) override;

 private:
  const mjModel& model_;
  DataPtr data_;
};

}  // namespace tether::sim
