#include "collision_rays.h"

#include "conversions.h"
#include "physics_model.h"

#include <algorithm>
#include <array>
#include <limits>

namespace tether::sim {

CollisionRays::CollisionRays(const mjModel& model) : model_(model), data_(make_data(model)) {}

void CollisionRays::cast(const RayBundle& bundle, std::span<double> distances_m) {
  for (std::size_t i = 0; i < bundle.X_WB.size(); ++i) {
    copy_to(bundle.X_WB[i], data_->qpos + qpos_address(i));
  }
  mj_kinematics(&model_, data_.get());
  std::array<mjtNum, 3> origin{};
  copy_to(bundle.X_WS.p, origin.data());
  const auto distance_m = [&](const uav::Vec3& ray_S) {
    std::array<mjtNum, 3> direction{};
    copy_to(rotate(bundle.X_WS.q, ray_S), direction.data());
    int geom = -1;
    const double met_m = mj_ray(&model_, data_.get(), origin.data(), direction.data(), nullptr, 1,
                                engine_body(bundle.ignored), &geom);
    return geom >= 0 ? met_m : std::numeric_limits<double>::infinity();
  };
  std::transform(bundle.rays_S.begin(), bundle.rays_S.end(), distances_m.begin(), distance_m);
}

}  // namespace tether::sim
