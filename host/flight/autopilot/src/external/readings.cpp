#include "external/readings.h"

#include <algorithm>

#include <tether/base/random.h>
#include <tether/sim/geodesy.h>

namespace tether::autopilot {

Readings ideal_readings(const uav::BodyState& truth, const uav::Vec3& specific_force_B_m_s2,
                        const sim::Place& place, const uav::Vec3& magnetic_field_W_T) {
  const sim::Geodetic at = sim::geodetic_of(place, truth.p_WB);
  constexpr double kAccuracy_m = 0.5, kAccuracy_m_s = 0.1;
  return {.specific_force_B_m_s2 = specific_force_B_m_s2,
          .w_WB_B_rad_s = truth.w_WB_B,
          .field_B_T = rotate(inverse(truth.q_WB), magnetic_field_W_T),
          .pressure_Pa = sim::standard_pressure_pa(at.altitude_m),
          .position = {.sampled_at = {},
                       .has_fix = true,
                       .latitude_deg = at.latitude_deg,
                       .longitude_deg = at.longitude_deg,
                       .altitude_m = at.altitude_m,
                       .velocity_ENU_m_s = sim::to_enu(place, truth.v_WB),
                       .horizontal_accuracy_m = kAccuracy_m,
                       .vertical_accuracy_m = kAccuracy_m,
                       .speed_accuracy_m_s = kAccuracy_m_s}};
}

Readings with_noise(Readings readings, std::uint64_t seed, std::uint64_t step) {
  constexpr double kForce_m_s2 = 0.03, kRate_rad_s = 0.002, kField_T = 1e-7, kPressure_Pa = 0.6;
  KeyedRandom random({seed, random_stream("controller", "", "own noise"), step});
  const auto add = [&](uav::Vec3& v, double stddev) {
    v.x += stddev * random.normal();
    v.y += stddev * random.normal();
    v.z += stddev * random.normal();
  };
  add(readings.specific_force_B_m_s2, kForce_m_s2);
  add(readings.w_WB_B_rad_s, kRate_rad_s);
  add(readings.field_B_T, kField_T);
  readings.pressure_Pa += kPressure_Pa * random.normal();
  return readings;
}

const sim::Sensor* sensor_of(const sim::Uav& vehicle, uav::SensorKind kind) {
  const auto found = std::ranges::find(vehicle.sensors, kind, &sim::Sensor::kind);
  return found == vehicle.sensors.end() ? nullptr : &*found;
}

Readings readings_of(const ExternalSettings& settings, const Sensed& sensed) {
  const auto* imu = sensor_of(settings.vehicle, uav::SensorKind::kImu);
  const auto* compass = sensor_of(settings.vehicle, uav::SensorKind::kMagnetometer);
  const auto measured = std::get<uav::ImuSample>(*sensed.measure(uav::SensorKind::kImu));
  Readings readings =
      ideal_readings(sensed.truth, rotate(imu->X_BS.q, measured.specific_force_m_s2),
                     settings.place, settings.magnetic_field_T);
  readings.w_WB_B_rad_s = rotate(imu->X_BS.q, measured.angular_velocity_rad_s);
  if (const auto sample = sensed.measure(uav::SensorKind::kMagnetometer))
    readings.field_B_T =
        rotate(compass->X_BS.q, std::get<uav::MagnetometerSample>(*sample).field_T);
  if (const auto sample = sensed.measure(uav::SensorKind::kBarometer))
    readings.pressure_Pa = std::get<uav::BarometerSample>(*sample).pressure_Pa;
  if (const auto sample = sensed.measure(uav::SensorKind::kNavSat))
    readings.position = std::get<uav::NavSatSample>(*sample);
  return readings;
}

}  // namespace tether::autopilot
