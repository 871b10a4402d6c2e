// Sensors that say where a UAV is: navsat, magnetometer, air_pressure and altimeter, and Gazebo
// Sim's plugin that publishes an odometry.

#include "files/sdf_numbers.h"
#include "sensors/sdf_sensor.h"

#include <string>

namespace tether::sim {
namespace {

/// How the pressure falls with the altitude, at sea level [Pa/m] (ISO 2533).
constexpr double kPressureSlope_Pa_m = 12.013;

/// Of an altitude [m], as noise of its pressure [Pa].
Noise noise_of_pressure(Noise noise) {
  for (double* value : {&noise.mean, &noise.stddev, &noise.bias_mean, &noise.bias_stddev,
                        &noise.dynamic_bias_stddev})
    *value *= kPressureSlope_Pa_m;
  return noise;
}

BarometerModel read_air_pressure(const SensorReading& reading, const sdf::AirPressure& sensor) {
  BarometerModel model;
  model.pressure_Pa = read_noise(reading.source, sensor.PressureNoise(), reading.warn);
  const sdf::ElementPtr altitude = sensor.Element()->FindElement("reference_altitude");
  if (altitude && altitude->GetExplicitlySetInFile())
    model.reference_altitude_m = sensor.ReferenceAltitude();
  return model;
}

}  // namespace

bool read_navsat(const SensorReading& reading) {
  const sdf::NavSat* navsat = reading.from.NavSatSensor();
  if (navsat == nullptr) return false;
  const auto noise = [&](const sdf::Noise& n) {
    return read_noise(reading.source, n, reading.warn);
  };
  NavSatModel model;
  model.horizontal_m = noise(navsat->HorizontalPositionNoise());
  model.vertical_m = noise(navsat->VerticalPositionNoise());
  model.horizontal_velocity_m_s = noise(navsat->HorizontalVelocityNoise());
  model.vertical_velocity_m_s = noise(navsat->VerticalVelocityNoise());
  reading.sensor.model = model;
  return true;
}

bool read_magnetometer(const SensorReading& reading) {
  const sdf::Magnetometer* magnetometer = reading.from.MagnetometerSensor();
  if (magnetometer == nullptr) return false;
  const auto noise = [&](const sdf::Noise& n) {
    return read_noise(reading.source, n, reading.warn);
  };
  reading.sensor.model = MagnetometerModel{
      {noise(magnetometer->XNoise()), noise(magnetometer->YNoise()), noise(magnetometer->ZNoise())},
      {}};
  return true;
}

// An altimeter measures the pressure, too.
bool read_barometer(const SensorReading& reading) {
  if (const sdf::AirPressure* air = reading.from.AirPressureSensor()) {
    reading.sensor.model = read_air_pressure(reading, *air);
    return true;
  }
  const sdf::Altimeter* altimeter = reading.from.AltimeterSensor();
  if (altimeter == nullptr) return false;
  BarometerModel model;
  model.pressure_Pa = noise_of_pressure(
      read_noise(reading.source, altimeter->VerticalPositionNoise(), reading.warn));
  reading.sensor.model = model;
  return true;
}

void add_odometry(const SdfSource& source, const sdf::ElementPtr& model, Uav& uav) {
  for_each_child(model, [&](const sdf::ElementPtr& plugin) {
    if (!is_odometry_plugin(plugin)) return;
    const auto number = [&](const char* name, double fallback) {
      const sdf::ElementPtr element = plugin->FindElement(name);
      return element ? read_numbers(source, element, 1)[0] : fallback;
    };
    constexpr double kRate_hz = 50.0;  // Gazebo's
    const double rate_hz = number("odom_publish_frequency", kRate_hz);
    const double stddev = number("gaussian_noise", 0.0);
    if (rate_hz <= 0.0 || stddev < 0.0)
      refuse(source, plugin,
             "must have an <odom_publish_frequency> above 0 Hz and no negative <gaussian_noise>");
    Noise noise;
    noise.stddev = stddev;
    uav.sensors.push_back({"odometry",
                           {},
                           rate_hz,
                           OdometryModel{noise, noise, noise, noise, noise},
                           source.where(plugin)});
  });
}

}  // namespace tether::sim
