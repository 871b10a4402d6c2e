#include "pose_track.h"

#include "dead_reckoning.h"

#include <algorithm>

namespace tether::tasks {
namespace {

constexpr Duration kRemembered = std::chrono::seconds(2);
/// Share of the difference to the odometry that each of its measurements corrects.
constexpr double kTrustInOdometry = 0.2;

}  // namespace

void PoseTrack::update(const uav::ImuSample& reading) {
  if (!has_started() || reading.sampled_at <= now().at) return;
  const double dt_s = to_seconds(reading.sampled_at - now().at);
  const uav::Vec3 a_W =
      rotate(reading.q_WS, reading.specific_force_m_s2) - uav::Vec3{0.0, 0.0, kGravity_m_s2};
  State next = now();
  next.at = reading.sampled_at;
  next.q_WB = reading.q_WS * q_SB_;
  next.v_WB_m_s = next.v_WB_m_s + 0.5 * dt_s * (a_W_ + a_W);
  next.p_WB = next.p_WB + 0.5 * dt_s * (now().v_WB_m_s + next.v_WB_m_s);
  a_W_ = a_W;
  states_.push_back(next);
  while (next.at - states_.front().at > kRemembered) states_.pop_front();
}

void PoseTrack::update(const uav::OdometrySample& odometry) {
  if (!has_started()) {
    states_.push_back({odometry.sampled_at, odometry.p_WS, odometry.v_WS_m_s, odometry.q_WS});
    return;
  }
  const State then = at(odometry.sampled_at);
  State& state = states_.back();
  state.p_WB = state.p_WB + kTrustInOdometry * (odometry.p_WS - then.p_WB);
  state.v_WB_m_s = state.v_WB_m_s + kTrustInOdometry * (odometry.v_WS_m_s - then.v_WB_m_s);
}

const PoseTrack::State& PoseTrack::at(SimTime instant) const {
  const auto later = std::ranges::lower_bound(states_, instant, std::ranges::less{}, &State::at);
  if (later == states_.end()) return states_.back();
  if (later == states_.begin()) return *later;
  const auto earlier = std::prev(later);
  return instant - earlier->at < later->at - instant ? *earlier : *later;
}

}  // namespace tether::tasks
