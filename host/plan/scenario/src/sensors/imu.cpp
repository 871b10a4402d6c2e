#include "sensors/sensor_key.h"

namespace tether::scenario {

// The same noise on each of the three axes.
std::vector<SensorKey> keys_of(std::type_identity<sim::ImuModel>) {
  using sim::ImuModel;
  return {
      row<ImuModel>("angular_velocity_noise_rad_s", noise,
                    [](ImuModel& imu, const auto& noise) { imu.angular_velocity.fill(noise); }),
      row<ImuModel>("linear_acceleration_noise_m_s2", noise,
                    [](ImuModel& imu, const auto& noise) { imu.linear_acceleration.fill(noise); }),
  };
}

}  // namespace tether::scenario
