#pragma once

#include <algorithm>
#include <cmath>

#include <tether/energy/meter.h>

/// What the models say in closed form or by another way, to compare flights with.
namespace tether::energy {

/// The energy that the battery gives from that charge until it is empty, without losses [J].
inline double stored_energy_J(const Battery& battery, double charge) {
  double integral = 0.0;
  const auto& points = battery.voltage_at_charge;
  for (std::size_t i = 1; i < points.size() && points[i - 1].first < charge; ++i) {
    const double to = std::min(charge, points[i].first);
    integral += (to - points[i - 1].first) *
                (points[i - 1].second + open_circuit_voltage_V(battery, to)) / 2.0;
  }
  return integral * battery.capacity_C;
}

/// Electrical power in steady level flight at that speed, with the tilt and thrust that drag
/// demands.
inline double level_flight_power_W(const uav::MultirotorParameters& airframe,
                                   const Propulsion& propulsion, double gravity_m_s2,
                                   double speed_m_s) {
  const auto rotors = static_cast<double>(airframe.rotors.size());
  const double weight_N = airframe.mass_kg * gravity_m_s2;
  double thrust_N = weight_N, speed_rad_s = 0.0, sine = 0.0;
  // The drag depends on the rotors' speed, which depends on the thrust that overcomes it.
  for (int i = 0; i < 50; ++i) {
    speed_rad_s = std::sqrt(thrust_N / rotors / airframe.thrust_coefficient);
    const double drag_N =
        (rotors * airframe.drag_coefficient * speed_rad_s + airframe.linear_drag_N_s_m) * speed_m_s;
    thrust_N = std::hypot(weight_N, drag_N);
    sine = drag_N / thrust_N;
  }
  const uav::Vec3 v_hub_B{speed_m_s * std::sqrt(1.0 - sine * sine), 0.0, speed_m_s * sine};
  return rotors * rotor_power(airframe, propulsion, speed_rad_s, v_hub_B).total_w() /
         propulsion.efficiency;
}

/// The speed of steady level flight with the least energy per metre, up to
/// `max_horizontal_speed_m_s`. @param other_W what the UAV also draws, at any speed.
inline double best_range_speed_m_s(const uav::MultirotorParameters& airframe,
                                   const Propulsion& propulsion, double gravity_m_s2,
                                   double other_W) {
  double best_m_s = 0.0, least_J_m = 0.0;
  constexpr int kPlaces = 1000;
  for (int i = 1; i <= kPlaces; ++i) {
    const double speed_m_s = airframe.max_horizontal_speed_m_s * i / kPlaces;
    const double J_m =
        (level_flight_power_W(airframe, propulsion, gravity_m_s2, speed_m_s) + other_W) / speed_m_s;
    if (best_m_s == 0.0 || J_m < least_J_m) {
      best_m_s = speed_m_s;
      least_J_m = J_m;
    }
  }
  return best_m_s;
}

}  // namespace tether::energy
