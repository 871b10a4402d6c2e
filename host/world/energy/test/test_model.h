#pragma once

#include <tether/energy/meter.h>

namespace tether::energy {

inline constexpr double kGravity_m_s2 = 9.81;
inline const uav::MultirotorParameters kAirframe = uav::hummingbird();

/// Of uav::hummingbird(), with three cells of 2.1 Ah.
inline Model hummingbird_model() {
  Model model;
  model.propulsion = {.rotor_radius_m = 0.1, .efficiency = 0.7, .nominal_voltage_V = 11.1};
  model.battery = {.capacity_C = 2.1 * 3600.0,
                   .voltage_at_charge = {{0.0, 9.9}, {0.1, 10.8}, {1.0, 12.6}},
                   .resistance_ohm = 0.05,
                   .cut_off_V = 9.0};
  model.computer = {.idle_W = 2.3, .busy_core_W = 1.0};
  model.sensors_W = 1.5;
  return model;
}

}  // namespace tether::energy
