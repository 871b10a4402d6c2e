#pragma once

#include "convert/sdf_convert.h"

#include <optional>

/// Sensors of SDF files. Each kind has a file in this folder.
namespace tether::sim {

/// A sensor of SDF, and what it becomes: `sensor.model` is set by the reader of its kind.
struct SensorReading {
  const SdfSource& source;
  const sdf::Sensor& from;
  const WarningSink& warn;
  Sensor& sensor;
};

/// Each reads sensors of its kind, and returns whether this is one.
/// @throws Error(kBadFile) for impossible values.
bool read_camera(const SensorReading& reading);
bool read_imu(const SensorReading& reading);
bool read_range(const SensorReading& reading);
bool read_navsat(const SensorReading& reading);
bool read_magnetometer(const SensorReading& reading);
bool read_barometer(const SensorReading& reading);

/// A channel's noise. Warns of quantization.
Noise read_noise(const SdfSource& source, const sdf::Noise& noise, const WarningSink& warn);

}  // namespace tether::sim
