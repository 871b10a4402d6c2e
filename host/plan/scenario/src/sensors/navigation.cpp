// Sensors that say where the UAV is.

#include "sensors/sensor_key.h"

#include <fmt/format.h>

#include <tether/base/units.h>

namespace tether::scenario {

std::vector<SensorKey> keys_of(std::type_identity<sim::NavSatModel>) {
  using sim::NavSatModel;
  constexpr toml::Range kOutage_s{.min = 0.0, .max = 1e6};
  return {
      row<NavSatModel>("horizontal_noise_m", noise, &NavSatModel::horizontal_m),
      row<NavSatModel>("vertical_noise_m", noise, &NavSatModel::vertical_m),
      row<NavSatModel>("horizontal_velocity_noise_m_s", noise,
                       &NavSatModel::horizontal_velocity_m_s),
      row<NavSatModel>("vertical_velocity_noise_m_s", noise, &NavSatModel::vertical_velocity_m_s),
      row<NavSatModel>("outage_every_s", number(kOutage_s), &NavSatModel::outage_every_s),
      row<NavSatModel>("outage_lasts_s", number(kOutage_s), &NavSatModel::outage_lasts_s),
  };
}

void complete(sim::NavSatModel& navsat, const Finished& sensor) {
  if (navsat.outage_every_s > 0.0 && !sensor.laid.has("outage_lasts_s"))
    sensor.refuse({"outage_every_s"}, "has outage_every_s, but no outage_lasts_s: give both.");
  if (navsat.outage_lasts_s <= navsat.outage_every_s) return;
  sensor.refuse({"outage_lasts_s", "outage_every_s"},
                fmt::format("has outage_lasts_s = {:.6g} and outage_every_s = {:.6g}. An outage "
                            "lasts at most as long as the time in which one begins.",
                            navsat.outage_lasts_s, navsat.outage_every_s));
}

std::vector<SensorKey> keys_of(std::type_identity<sim::MagnetometerModel>) {
  using sim::MagnetometerModel;
  const auto read_field = [](const toml::Table& table, std::string_view key) {
    constexpr toml::Range kField_T{.min = -1e-2, .max = 1e-2};
    const auto field_T = table.numbers(key, 3, kField_T);
    return uav::Vec3{field_T[0], field_T[1], field_T[2]};
  };
  return {
      row<MagnetometerModel>("noise_T", noise,
                             [](MagnetometerModel& magnetometer, const auto& noise) {
                               magnetometer.field_T.fill(noise);
                             }),
      row<MagnetometerModel>("hard_iron_T", read_field, &MagnetometerModel::hard_iron_T),
  };
}

std::vector<SensorKey> keys_of(std::type_identity<sim::BarometerModel>) {
  using sim::BarometerModel;
  return {row<BarometerModel>("noise_Pa", noise, &BarometerModel::pressure_Pa)};
}

std::vector<SensorKey> keys_of(std::type_identity<sim::OdometryModel>) {
  using sim::OdometryModel;
  return {
      row<OdometryModel>("position_noise_m", noise, &OdometryModel::position_m),
      row<OdometryModel>("velocity_noise_m_s", noise, &OdometryModel::velocity_m_s),
      row<OdometryModel>("tilt_noise_rad", noise, &OdometryModel::tilt_rad),
      row<OdometryModel>("yaw_noise_rad", noise, &OdometryModel::yaw_rad),
      row<OdometryModel>("angular_velocity_noise_rad_s", noise,
                         &OdometryModel::angular_velocity_rad_s),
  };
}

}  // namespace tether::scenario
