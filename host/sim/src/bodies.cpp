#include <tether/sim/bodies.h>

namespace tether::sim {

std::vector<MovingBody> moving_bodies(const World& world) {
  std::vector<MovingBody> bodies;
  for (const Uav& uav : world.uavs) bodies.push_back({&uav.body, &uav, nullptr, uav.X_WB});
  for (const Model& model : world.models) {
    if (model.is_static) continue;
    for (const Link& link : model.links) {
      bodies.push_back({&link, nullptr, &model, model.X_WM * link.X_ML});
    }
  }
  return bodies;
}

std::vector<FixedBody> fixed_bodies(const World& world) {
  std::vector<FixedBody> bodies;
  for (const Model& model : world.models) {
    if (!model.is_static) continue;
    for (const Link& link : model.links) bodies.push_back({&link, model.X_WM * link.X_ML, &model});
  }
  return bodies;
}

}  // namespace tether::sim
