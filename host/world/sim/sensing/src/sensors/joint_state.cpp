#include "sensors/joint_state.h"

namespace tether::sim {

uav::JointStateSample measure_joint_state(const JointStateModel& model,
                                          const std::vector<uav::Joint>& joints,
                                          std::span<const double> angles_rad,
                                          const MeasurementKey& key) {
  uav::JointStateSample sample{key.at, key.index, {angles_rad.begin(), angles_rad.end()}};
  for (std::size_t i = 0; i < joints.size(); ++i)
    sample.angles_rad[i] += noise_of(model.angle_rad, key, joints[i].name);
  return sample;
}

}  // namespace tether::sim
