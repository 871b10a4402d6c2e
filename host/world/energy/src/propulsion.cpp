#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <tether/energy/meter.h>

namespace tether::energy {
namespace {

/// v of Glauert's equation, by Newton's method on v⁴ + 2 V∥ v³ + (V⊥² + V∥²) v² − v_h⁴ = 0: for
/// V∥ ≥ 0 it has one positive root, and the steps from v_h, which is not below it, only fall.
double induced_velocity_m_s(double in_hover, double across, double along) {
  if (in_hover <= 0.0) return 0.0;
  const double squares = across * across + along * along;
  const double wanted = std::pow(in_hover, 4);
  double v = in_hover;
  for (int i = 0; i < 20; ++i) {
    const double f = ((v + 2.0 * along) * v + squares) * v * v - wanted;
    const double slope = ((4.0 * v + 6.0 * along) * v + 2.0 * squares) * v;
    const double step = f / slope;
    v -= step;
    if (std::abs(step) < 1e-9 * in_hover) break;
  }
  return v;
}

double disc_area_m2(const Propulsion& propulsion) {
  return std::numbers::pi * propulsion.rotor_radius_m * propulsion.rotor_radius_m;
}

double hover_velocity_m_s(const Propulsion& propulsion, double thrust_N) {
  return std::sqrt(thrust_N / (2.0 * propulsion.air_density_kg_m3 * disc_area_m2(propulsion)));
}

}  // namespace

RotorPower rotor_power(const uav::MultirotorParameters& airframe, const Propulsion& propulsion,
                       double speed_rad_s, const uav::Vec3& v_hub_B) {
  const double thrust_N = airframe.thrust_coefficient * speed_rad_s * speed_rad_s;
  const double in_hover_m_s = hover_velocity_m_s(propulsion, thrust_N);
  const double across_m_s = std::hypot(v_hub_B.x, v_hub_B.y);
  const double induced_m_s =
      induced_velocity_m_s(in_hover_m_s, across_m_s, std::max(0.0, v_hub_B.z));
  // Both grow with the speed to the third.
  const double reaction_W = airframe.moment_coefficient_m * thrust_N * speed_rad_s;
  const double profile_W =
      std::max(0.0, reaction_W - propulsion.induced_factor * thrust_N * in_hover_m_s);
  const double tip_m_s = speed_rad_s * propulsion.rotor_radius_m;
  const double advance = tip_m_s > 0.0 ? across_m_s / tip_m_s : 0.0;
  return {.induced_W = propulsion.induced_factor * thrust_N * induced_m_s,
          .profile_W = profile_W * (1.0 + 4.65 * std::min(1.0, advance * advance)),
          .parasitic_W = thrust_N * v_hub_B.z};
}

double propulsion_power_W(const uav::MultirotorParameters& airframe, const Propulsion& propulsion,
                          const uav::MultirotorState& rotors, const uav::BodyState& body) {
  const uav::Vec3 v_B = rotate(inverse(body.q_WB), body.v_WB);
  double sum_W = 0.0;
  for (std::size_t i = 0; i < airframe.rotors.size(); ++i) {
    const uav::Vec3 v_hub_B = v_B + cross(body.w_WB_B, airframe.rotors[i].p_BR);
    sum_W += std::max(
        0.0, rotor_power(airframe, propulsion, rotors.rotor_speed_rad_s[i], v_hub_B).total_w());
  }
  return sum_W / propulsion.efficiency;
}

}  // namespace tether::energy
