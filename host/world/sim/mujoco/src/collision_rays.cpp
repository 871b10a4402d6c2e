#include "collision_rays.h"

#include "conversions.h"

#include <array>
#include <limits>

namespace tether::sim {

CollisionRays::CollisionRays(const mjModel& model, const World& world)
    : model_(model), shapes_(shapes_of(world)), data_(make_data(model)) {}

void CollisionRays::cast(const RayBundle& bundle, std::span<double> distances_m) {
  cast_with_intensities(bundle, distances_m, {});
}

bool CollisionRays::cast_with_intensities(const RayBundle& bundle, std::span<double> distances_m,
                                          std::span<float> intensities) {
  for (std::size_t i = 0; i < bundle.X_WB.size(); ++i) {
    copy_to(bundle.X_WB[i], data_->qpos + qpos_address(i));
  }
  mj_kinematics(&model_, data_.get());
  std::array<mjtNum, 3> origin{};
  copy_to(bundle.X_WS.p, origin.data());
  for (std::size_t i = 0; i < bundle.rays_S.size(); ++i) {
    std::array<mjtNum, 3> direction{};
    copy_to(rotate(bundle.X_WS.q, bundle.rays_S[i]), direction.data());
    int geom = -1;
    const double met_m = mj_ray(&model_, data_.get(), origin.data(), direction.data(), nullptr, 1,
                                engine_body(bundle.ignored), &geom);
    distances_m[i] = geom >= 0 ? met_m : std::numeric_limits<double>::infinity();
    if (!intensities.empty())
      intensities[i] = geom >= 0 ? shapes_[static_cast<std::size_t>(geom)].intensity : 0.0F;
  }
  return true;
}

}  // namespace tether::sim
