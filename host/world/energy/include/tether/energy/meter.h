#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <tether/base/time.h>
#include <tether/uav/multirotor.h>

/// The energy of a UAV: what its rotors, its computer and its sensors draw from its battery. Pure.
namespace tether::energy {

// ---- The power of rotors, by momentum theory with a profile part (Leishman, "Principles of
// Helicopter Aerodynamics", 2nd edition, 2006, sections 2.14 and 5.4).

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

/// A battery: an open-circuit voltage that falls with its charge, behind an internal resistance.
struct Battery {
  double capacity_C = 0.0;  ///< [A s]; > 0
  /// Open-circuit voltage [V] at shares of the charge from 0 to 1, both included, rising; linear in
  /// between. Neither decreases.
  std::vector<std::pair<double, double>> voltage_at_charge;
  double resistance_ohm = 0.0;  ///< ≥ 0
  double cut_off_V = 0.0;       ///< empty below this terminal voltage, under load
  double initial_charge = 1.0;  ///< share of the capacity; (0, 1]
};

/// @param charge in [0, 1]
double open_circuit_voltage_V(const Battery& battery, double charge);

/// What a battery gives at one instant.
struct Discharge {
  double voltage_V = 0.0;  ///< at the terminals
  double current_A = 0.0;
  double power_W = 0.0;  ///< at the terminals: what was asked for, or the most that it can give
  double heat_W = 0.0;   ///< lost in the internal resistance
  bool is_exhausted = false;  ///< without charge, below the cut-off, or asked for more than it has
};
/// @param charge in [0, 1] @param power_W asked for at the terminals; ≥ 0
Discharge discharge(const Battery& battery, double charge, double power_W);

/// What energy is spent on.
enum class Cause {
  kLift,        ///< what hovering takes
  kMoving,      ///< the rotors beyond that; negative where flying ahead takes less than hovering
  kIdle,        ///< the computer, as long as it is on
  kComputing,   ///< the computer's busy cores
  kSensors,     ///< sensors, radio and whatever else draws a constant power
  kResistance,  ///< heat of the battery's internal resistance
};
inline constexpr std::size_t kCauses = 6;
/// "lift", "moving", "idle", "computing", "sensors", "resistance".
std::string_view name(Cause cause);
using Energies_J = std::array<double, kCauses>;  ///< by Cause

struct Computer {
  double idle_W = 0.0;
  double busy_core_W = 0.0;  ///< what a core that computes takes more
  friend bool operator==(const Computer&, const Computer&) = default;
};

struct Model {
  Propulsion propulsion;
  Battery battery;
  Computer computer;
  double sensors_W = 0.0;  ///< sensors and radio
};

/// At one instant.
struct Status {
  double voltage_V = 0.0;
  double current_A = 0.0;
  double charge = 1.0;                ///< share of the capacity
  Energies_J spent_J{};               ///< since ST 0
  std::optional<SimTime> empty_at{};  ///< when the battery was exhausted; the rotors have no power
                                      ///< since
  friend bool operator==(const Status&, const Status&) = default;
};

/// Follows one UAV through a run. A value; allocates nothing per step.
class Meter {
 public:
  /// `model` and `airframe` must outlive it. At ST 0.
  Meter(const Model& model, const uav::MultirotorParameters& airframe, double gravity_m_s2);

  /// From now on, so many of the computer's cores are busy.
  void computing(double cores) { busy_cores_ = cores; }
  /// One step from `from` on, with the state at its beginning.
  void step(SimTime from, Duration dt, const uav::BodyState& body,
            const uav::MultirotorState& rotors);

  /// What the battery's voltage leaves of the greatest rotor speed; in [0, 1].
  double speed_limit() const;
  const Status& status() const { return status_; }

 private:
  const Model* model_;
  const uav::MultirotorParameters* airframe_;
  double hover_W_;
  double busy_cores_ = 0.0;
  Status status_;
};

}  // namespace tether::energy
