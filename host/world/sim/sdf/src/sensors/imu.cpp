#include "sensors/sdf_sensor.h"

namespace tether::sim {

bool read_imu(const SensorReading& reading) {
  const sdf::Imu* imu = reading.from.ImuSensor();
  if (imu == nullptr) return false;
  const auto noise = [&](const sdf::Noise& n) {
    return read_noise(reading.source, n, reading.warn);
  };
  reading.sensor.model =
      ImuModel{{noise(imu->AngularVelocityXNoise()), noise(imu->AngularVelocityYNoise()),
                noise(imu->AngularVelocityZNoise())},
               {noise(imu->LinearAccelerationXNoise()), noise(imu->LinearAccelerationYNoise()),
                noise(imu->LinearAccelerationZNoise())}};
  return true;
}

}  // namespace tether::sim
