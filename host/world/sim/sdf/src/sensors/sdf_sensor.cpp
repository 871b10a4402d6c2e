#include "sensors/sdf_sensor.h"

#include <algorithm>
#include <array>

namespace tether::sim {
namespace {

constexpr std::array kReaders = {read_camera, read_imu,          read_range,
                                 read_navsat, read_magnetometer, read_barometer};

}  // namespace

Noise read_noise(const SdfSource& source, const sdf::Noise& noise, const WarningSink& warn) {
  if (noise.Type() == sdf::NoiseType::NONE) return {};
  if (noise.Type() == sdf::NoiseType::GAUSSIAN_QUANTIZED) {
    warn_at(source, noise.Element(), Consequence::kBehavesDifferent,
            "is quantized, which is not simulated; treated as gaussian", warn);
  }
  return {noise.Mean(),
          noise.StdDev(),
          noise.BiasMean(),
          noise.BiasStdDev(),
          noise.DynamicBiasStdDev(),
          noise.DynamicBiasCorrelationTime()};
}

std::optional<Sensor> read_sensor(const SdfSource& source, const sdf::Sensor& sensor,
                                  const uav::Pose& X_BL, const WarningSink& warn) {
  Sensor result{sensor.Name(),
                X_BL * resolved_pose(source, sensor),
                sensor.UpdateRate(),
                {},
                source.where(sensor.Element())};
  const SensorReading reading{source, sensor, warn, result};
  const bool is_read = std::ranges::any_of(kReaders, [&](auto* read) { return read(reading); });
  return is_read ? std::optional(result) : std::nullopt;
}

}  // namespace tether::sim
