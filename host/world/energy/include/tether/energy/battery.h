#pragma once

#include <utility>
#include <vector>

namespace tether::energy {

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

}  // namespace tether::energy
