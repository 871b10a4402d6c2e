#include "shutter.h"
#include "state_numbers.h"

#include <algorithm>
#include <cmath>

#include <tether/base/error.h>
#include <tether/sim/bodies.h>
#include <tether/sim_sensing/state_layout.h>

namespace tether::sim {
namespace {

constexpr double kLongestWindow_s = 1.0;

double checked_window_s(const Uav& uav, const Sensor& sensor, const CameraModel& camera) {
  const double window_s = Shutter(camera).window_s();
  if (camera.exposure_s >= 0.0 && camera.readout_s >= 0.0 && window_s <= kLongestWindow_s) {
    return window_s;
  }
  throw Error(ErrorCode::kBadFile,
              "camera '" + sensor.name + "' of UAV '" + uav.name +
                  "': exposure and readout must be at least 0, and at most 1 s "
                  "together")
      .about(sensor.name);
}

// Between two poses that are near each other, `share` of the way.
uav::Pose between(const uav::Pose& a, const uav::Pose& b, double share) {
  const auto mix = [&](double x, double y) { return x + share * (y - x); };
  // A quaternion and its opposite are the same rotation.
  const double sign = a.q.w * b.q.w + a.q.x * b.q.x + a.q.y * b.q.y + a.q.z * b.q.z < 0 ? -1 : 1;
  return {a.p + share * (b.p - a.p),
          uav::normalized({mix(a.q.w, sign * b.q.w), mix(a.q.x, sign * b.q.x),
                           mix(a.q.y, sign * b.q.y), mix(a.q.z, sign * b.q.z)})};
}

}  // namespace

std::size_t shutter_steps(const World& world) {
  double longest_s = 0.0;
  for (const Uav& uav : world.uavs) {
    for (const Sensor& sensor : uav.sensors) {
      const auto* camera = std::get_if<CameraModel>(&sensor.model);
      if (camera) longest_s = std::max(longest_s, checked_window_s(uav, sensor, *camera));
    }
  }
  return static_cast<std::size_t>(std::ceil(longest_s / to_seconds(world.step)));
}

StateLayout::StateLayout(const World& world)
    : bodies_(moving_bodies(world).size()),
      uavs_(world.uavs.size()),
      past_steps_(shutter_steps(world)) {}

std::size_t StateLayout::size() const {
  return past_at() + past_steps_ * bodies_ * kPoseSize;
}

std::size_t StateLayout::motion_at(std::size_t uav) const {
  return bodies_ * kPoseSize + uav * kMotionSize;
}

uav::Pose StateLayout::pose_of(const std::vector<double>& state, std::size_t body) const {
  return read_pose(state.data() + body * kPoseSize);
}

BodyMotion StateLayout::motion_of(const std::vector<double>& state, std::size_t uav) const {
  const double* motion = state.data() + motion_at(uav);
  return {read_vec3(motion), read_vec3(motion + 3), read_vec3(motion + 6)};
}

uav::Pose StateLayout::past_pose_of(const std::vector<double>& state, std::size_t body,
                                    double steps_ago) const {
  // The pose at a whole number of steps before the capture.
  const auto pose = [&](std::size_t steps) {
    if (steps == 0) return pose_of(state, body);
    const std::size_t row = past_steps_ - std::min(steps, past_steps_);
    return read_pose(state.data() + past_at() + (row * bodies_ + body) * kPoseSize);
  };
  const auto whole = static_cast<std::size_t>(steps_ago);
  const double share = steps_ago - static_cast<double>(whole);
  return share == 0.0 ? pose(whole) : between(pose(whole), pose(whole + 1), share);
}

}  // namespace tether::sim
