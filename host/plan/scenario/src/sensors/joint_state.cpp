#include "sensors/sensor_key.h"

namespace tether::scenario {

std::vector<SensorKey> keys_of(std::type_identity<sim::JointStateModel>) {
  return {row<sim::JointStateModel>("angle_noise_rad", noise, &sim::JointStateModel::angle_rad)};
}

}  // namespace tether::scenario
