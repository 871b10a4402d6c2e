#include "still_world.h"

#include <algorithm>
#include <limits>
#include <variant>

namespace tether::system_test {

namespace protocol = sim::protocol;

protocol::Reply StillWorld::answer(const protocol::Request& request) {
  return std::visit([this](const auto& r) { return reply_to(r); }, request);
}

std::vector<uav::Pose> StillWorld::poses() const {
  std::vector<uav::Pose> list;
  for (const auto& uav : open_.uavs) list.push_back(uav.X_WB);
  list.resize(list.size() + open_.bodies.size());
  return list;
}

protocol::State StillWorld::state(std::int64_t steps) const {
  protocol::State state;
  state.now = now_;
  const auto bodies = poses();
  for (const auto& X_WB : bodies) {
    uav::BodyState body;
    body.p_WB = X_WB.p;
    body.q_WB = X_WB.q;
    state.bodies.push_back(body);
  }
  state.motions.resize(open_.uavs.size());
  for (std::int64_t i = 0; i < std::min<std::int64_t>(steps, open_.past_steps); ++i)
    state.past.insert(state.past.end(), bodies.begin(), bodies.end());
  return state;
}

protocol::Reply StillWorld::reply_to(const protocol::Open& open) {
  open_ = open;
  now_ = {};
  return protocol::Opened{"a stand-in", state(0)};
}

protocol::Reply StillWorld::reply_to(const protocol::Reset&) {
  now_ = {};
  return state(0);
}

protocol::Reply StillWorld::reply_to(const protocol::Advance& advance) {
  const std::int64_t steps = (advance.to - now_) / open_.step;
  now_ = advance.to;
  return state(steps);
}

protocol::Reply StillWorld::reply_to(const protocol::CastRays& rays) {
  return protocol::Distances{
      std::vector<double>(rays.rays_S.size(), std::numeric_limits<double>::infinity())};
}

protocol::Reply StillWorld::reply_to(const protocol::Render& view) {
  const auto width = view.camera.width_px, height = view.camera.height_px;
  protocol::Picture picture{width, height, {}, 1.0, "grey"};
  picture.rgb.resize(static_cast<std::size_t>(width * height) * 3, 127);
  return picture;
}

}  // namespace tether::system_test
