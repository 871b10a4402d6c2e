#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <tether/record/reader.h>
#include <tether/uav/setpoint.h>

namespace tether::record {
namespace {

uav::Vec3 vec3(const double (&v)[3]) {
  return {v[0], v[1], v[2]};
}
uav::Pose pose_of(const GroundTruth& truth) {
  const double(&q)[4] = truth.q_WB;
  return {vec3(truth.p_WB_m), {q[0], q[1], q[2], q[3]}};
}

// Poses between two.

double dot(const uav::Quat& a, const uav::Quat& b) {
  return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}

uav::Quat blend(double share_a, const uav::Quat& a, double share_b, const uav::Quat& b) {
  return uav::normalized({share_a * a.w + share_b * b.w, share_a * a.x + share_b * b.x,
                          share_a * a.y + share_b * b.y, share_a * a.z + share_b * b.z});
}

uav::Quat slerp(const uav::Quat& a, const uav::Quat& b, double fraction) {
  // q and −q are one attitude; the nearer one is meant.
  const double sign = dot(a, b) < 0.0 ? -1.0 : 1.0;
  const double angle_rad = std::acos(std::min(1.0, std::abs(dot(a, b))));
  constexpr double kAsGoodAsLinear_rad = 1e-6;
  if (angle_rad < kAsGoodAsLinear_rad) return blend(1.0 - fraction, a, sign * fraction, b);
  return blend(std::sin((1.0 - fraction) * angle_rad), a, sign * std::sin(fraction * angle_rad), b);
}

uav::Pose between(const GroundTruth& before, const GroundTruth& after, SimTime instant) {
  const uav::Pose a = pose_of(before), b = pose_of(after);
  const double fraction = to_seconds(instant - before.at) / to_seconds(after.at - before.at);
  return {a.p + fraction * (b.p - a.p), slerp(a.q, b.q, fraction)};
}

}  // namespace

UavTrack::UavTrack(const Record& record, const std::string& uav)
    : period_(record.header.ground_truth_period) {
  for (const auto& logged : record.ground_truth)
    if (logged.message.uav == uav) truths_.push_back(&logged.message);
  std::ranges::stable_sort(truths_, {}, &GroundTruth::at);  // a damaged record can be in disorder
}

std::optional<uav::Pose> UavTrack::at(SimTime instant) const {
  const auto after = std::ranges::lower_bound(truths_, instant, {}, &GroundTruth::at);
  if (after != truths_.end() && ((*after)->at == instant || after != truths_.begin()))
    return (*after)->at == instant ? pose_of(**after) : between(**(after - 1), **after, instant);
  if (truths_.empty()) return std::nullopt;
  const GroundTruth& nearest = after == truths_.end() ? *truths_.back() : **after;
  const Duration off = std::max(instant - nearest.at, nearest.at - instant);
  return off > period_ ? std::nullopt : std::optional(pose_of(nearest));
}

std::vector<double> UavTrack::joints_rad(SimTime instant) const {
  if (truths_.empty()) return {};
  const auto after = std::ranges::lower_bound(truths_, instant, {}, &GroundTruth::at);
  const GroundTruth& next = after == truths_.end() ? *truths_.back() : **after;
  const GroundTruth& last = after == truths_.begin() ? next : **(after - 1);
  const bool is_between = last.at < instant && instant < next.at;
  const double share =
      is_between ? to_seconds(instant - last.at) / to_seconds(next.at - last.at) : 1.0;
  std::vector<double> angles_rad = next.joints_rad;
  for (std::size_t i = 0; i < std::min(angles_rad.size(), last.joints_rad.size()); ++i)
    angles_rad[i] = last.joints_rad[i] + share * (angles_rad[i] - last.joints_rad[i]);
  return angles_rad;
}

std::optional<uav::Pose> pose_at(const Record& record, const std::string& uav, SimTime instant) {
  return UavTrack(record, uav).at(instant);
}

SensorInfo mounted_at(const SensorInfo& camera, const Record& record, SimTime instant) {
  const auto sut = std::ranges::find(record.header.suts, camera.uav, &SutInfo::uav);
  if (!camera.camera || camera.camera->joints == 0 || sut == record.header.suts.end())
    return camera;
  std::vector<uav::Joint> joints;
  for (const JointInfo& joint : sut->joints)
    joints.push_back({.name = {}, .p_BJ = vec3(joint.p_BJ_m), .axis_B = vec3(joint.axis_B)});
  std::vector<double> angles_rad = UavTrack(record, camera.uav).joints_rad(instant);
  angles_rad.resize(
      std::min({angles_rad.size(), joints.size(), std::size_t{camera.camera->joints}}));
  const double(&q)[4] = camera.camera->q_BS;
  const uav::Pose X_BS =
      turned(joints, angles_rad, {vec3(camera.camera->p_BS_m), {q[0], q[1], q[2], q[3]}});
  SensorInfo now = camera;
  std::ranges::copy(std::initializer_list<double>{X_BS.p.x, X_BS.p.y, X_BS.p.z},
                    now.camera->p_BS_m);
  std::ranges::copy(std::initializer_list<double>{X_BS.q.w, X_BS.q.x, X_BS.q.y, X_BS.q.z},
                    now.camera->q_BS);
  return now;
}

AnchorTrack::AnchorTrack(const Anchor& anchor, const Record& record)
    : start_{.name = anchor.name, .shape = anchor.shape},
      X_WA_{vec3(anchor.p_WA_m), {anchor.q_WA[0], anchor.q_WA[1], anchor.q_WA[2], anchor.q_WA[3]}},
      path_{{}, anchor.path_repeats, anchor.path_delay},
      X_WO_{vec3(anchor.p_WO_m), {}},
      p_BA_(vec3(anchor.p_BA_m)) {
  std::ranges::copy(anchor.size_m, start_.size_m);
  for (const Waypoint& waypoint : anchor.path)
    path_.waypoints.push_back({waypoint.at, vec3(waypoint.p_m), waypoint.yaw_rad});
  if (!anchor.uav.empty()) uav_.emplace(record, anchor.uav);
}

Anchor AnchorTrack::at(SimTime instant) const {
  uav::Pose now = X_WA_;
  if (!path_.waypoints.empty())
    now = moved(X_WO_, state_at(path_, instant - SimTime{})) * (inverse(X_WO_) * X_WA_);
  if (const auto X_WB = uav_ ? uav_->at(instant) : std::nullopt) now = *X_WB * uav::Pose{p_BA_, {}};
  Anchor anchor = start_;
  std::ranges::copy(std::initializer_list<double>{now.p.x, now.p.y, now.p.z}, anchor.p_WA_m);
  std::ranges::copy(std::initializer_list<double>{now.q.w, now.q.x, now.q.y, now.q.z}, anchor.q_WA);
  return anchor;
}

}  // namespace tether::record
