#include "sensors/scan.h"
#include "state_numbers.h"

#include <algorithm>
#include <cmath>

#include <tether/base/error.h>
#include <tether/sim/bodies.h>
#include <tether/sim_sensing/state_layout.h>

namespace tether::sim {
namespace {

constexpr double kLongestWindow_s = 1.0;

void check_shutter(const Uav& uav, const Sensor& sensor, const CameraModel& camera) {
  const double window_s = camera.exposure_s + camera.readout_s;
  if (camera.exposure_s >= 0.0 && camera.readout_s >= 0.0 && window_s <= kLongestWindow_s) return;
  throw Error(ErrorCode::kBadFile,
              "camera '" + sensor.name + "' of UAV '" + uav.name +
                  "': exposure and readout must be at least 0, and at most 1 s "
                  "together")
      .about(sensor.name);
}

}  // namespace

std::size_t shutter_steps(const CameraModel& camera, Duration step) {
  return static_cast<std::size_t>(
      std::ceil((camera.exposure_s + camera.readout_s) / to_seconds(step)));
}

std::size_t shutter_steps(const World& world) {
  std::size_t most = 0;
  for (const Uav& uav : world.uavs) {
    for (const Sensor& sensor : uav.sensors) {
      if (const auto* scan = std::get_if<ScanModel>(&sensor.model))
        most = std::max(most, steps_ago(*scan, 0, world.step));
      const auto* camera = std::get_if<CameraModel>(&sensor.model);
      if (!camera) continue;
      check_shutter(uav, sensor, *camera);
      most = std::max(most, shutter_steps(*camera, world.step));
    }
  }
  return most;
}

StateLayout::StateLayout(const World& world)
    : bodies_(moving_bodies(world).size()),
      uavs_(world.uavs.size()),
      past_steps_(shutter_steps(world)),
      first_joint_{0} {
  for (const Uav& uav : world.uavs) first_joint_.push_back(first_joint_.back() + uav.joints.size());
}

std::size_t StateLayout::size() const {
  return past_at() + past_steps_ * row_size();
}

std::size_t StateLayout::row_size() const {
  return bodies_ * kPoseSize + joints();
}

std::size_t StateLayout::motion_at(std::size_t uav) const {
  return bodies_ * kPoseSize + uav * kMotionSize;
}

uav::Pose StateLayout::pose_of(const std::vector<double>& state, std::size_t body) const {
  return read_pose(state.data() + body * kPoseSize);
}

BodyMotion StateLayout::motion_of(const std::vector<double>& state, std::size_t uav) const {
  const double* motion = state.data() + motion_at(uav);
  return {read_vec3(motion), read_vec3(motion + 3), read_vec3(motion + 6), read_vec3(motion + 9)};
}

uav::Pose StateLayout::past_pose_of(const std::vector<double>& state, std::size_t body,
                                    std::size_t steps_ago) const {
  if (steps_ago == 0) return pose_of(state, body);
  const std::size_t row = past_steps_ - steps_ago;
  return read_pose(state.data() + past_at() + row * row_size() + body * kPoseSize);
}

std::span<const double> StateLayout::angles_of(const std::vector<double>& state,
                                               std::size_t uav) const {
  return std::span(state).subspan(motion_at(uavs_) + first_joint_[uav],
                                  first_joint_[uav + 1] - first_joint_[uav]);
}

uav::Pose StateLayout::turned_pose(const std::vector<double>& state, const World& world,
                                   const TurnedPart& part, const uav::Pose& X_B0,
                                   std::size_t steps_ago) const {
  if (part.joints == 0) return X_B0;
  const std::size_t end =
      steps_ago == 0 ? past_at() : past_at() + (past_steps_ - steps_ago + 1) * row_size();
  const std::size_t first = end - joints() + first_joint_[part.uav];
  return turned(world.uavs[part.uav].joints, std::span(state).subspan(first, part.joints), X_B0);
}

}  // namespace tether::sim
