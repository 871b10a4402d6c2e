#include <tether/sim/bodies.h>

namespace tether::sim {

std::vector<MovingBody> moving_bodies(const World& world) {
  std::vector<MovingBody> bodies;
  for (const Uav& uav : world.uavs) bodies.push_back({&uav.body, &uav, nullptr, uav.X_WB});
  for (const Model& model : world.models) {
    if (model.is_static) continue;
    for (const Link& link : model.links) {
      bodies.push_back({&link, nullptr, &model, start_of(model, link)});
    }
  }
  return bodies;
}

uav::Pose start_of(const Model& model, const Link& link) {
  const MovingBody body{&link, nullptr, &model, model.X_WM * link.X_ML};
  return model.path ? driven_state(body, SimTime{}).X_WB : body.X_WB;
}

std::vector<TurnedPart> turned_parts(const World& world) {
  std::vector<TurnedPart> parts;
  for (std::size_t uav = 0; uav < world.uavs.size(); ++uav)
    for (std::size_t joint = 0; joint < world.uavs[uav].joints.size(); ++joint)
      parts.push_back({uav, joint + 1});
  return parts;
}

DrivenState driven_state(const MovingBody& body, SimTime at) {
  const uav::PathState path = state_at(*body.model->path, at - SimTime{});
  const uav::Pose X_WO{body.model->path->p_WO, {}};
  const uav::Pose X_WO_now = moved(X_WO, path);
  const uav::Pose X_WB = X_WO_now * (inverse(X_WO) * (body.model->X_WM * body.link->X_ML));
  const uav::Vec3 arm = X_WB.p - X_WO_now.p;
  const uav::Vec3 w{0.0, 0.0, path.yaw_rate_rad_s}, alpha{0.0, 0.0, path.yaw_acceleration_rad_s2};
  return {X_WB, path.v_m_s + cross(w, arm), w,
          path.a_m_s2 + cross(alpha, arm) + cross(w, cross(w, arm)), alpha};
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
