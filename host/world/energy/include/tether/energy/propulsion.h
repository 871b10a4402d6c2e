#pragma once

#include <tether/uav/multirotor.h>

/// The power of rotors, by momentum theory with a profile part (Leishman, "Principles of
/// Helicopter Aerodynamics", 2nd edition, 2006, sections 2.14 and 5.4).
namespace tether::energy {

/// Of each rotor, besides its parameters of uav::MultirotorParameters.
struct Propulsion {
  double rotor_radius_m = 0.0;
  double induced_factor = 1.15;    ///< induced power relative to a uniform inflow, ≥ 1
  double efficiency = 1.0;         ///< mechanical power of the rotor per electrical power; (0, 1]
  double nominal_voltage_V = 0.0;  ///< at which the airframe reaches its greatest rotor speed
  double air_density_kg_m3 = 1.225;
};

/// Mechanical power of one rotor [W].
struct RotorPower {
  double induced_W = 0.0;    ///< accelerates the air
  double profile_W = 0.0;    ///< overcomes the drag of the blades
  double parasitic_W = 0.0;  ///< climbs, and overcomes the drag of the UAV; negative in descent
  double total_w() const { return induced_W + profile_W + parasitic_W; }
};

/// The power of one rotor.
/// - induced: κ T v, with v of Glauert's equation v = v_h² / √(V⊥² + (V∥ + v)²), v_h² = T / (2ρA);
///   if the rotor descends through its own wake (V∥ < 0), V∥ = 0, which is the hover's;
/// - profile: c ω³ (1 + 4.65 μ²), where c is what the rotor's reaction torque at hover leaves
///   beside the induced power: no other parameter of the blades is needed;
/// - parasitic: T V∥. In steady flight this is the power of drag and climb.
/// @param v_hub_B velocity of the hub through still air, in the body frame: V∥ is its z.
RotorPower rotor_power(const uav::MultirotorParameters& airframe, const Propulsion& propulsion,
                       double speed_rad_s, const uav::Vec3& v_hub_B);

/// Electrical power of all rotors [W]: never negative, because the motors do not charge.
double propulsion_power_W(const uav::MultirotorParameters& airframe, const Propulsion& propulsion,
                          const uav::MultirotorState& rotors, const uav::BodyState& body);

}  // namespace tether::energy
