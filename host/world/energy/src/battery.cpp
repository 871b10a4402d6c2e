#include <algorithm>
#include <cmath>

#include <tether/energy/meter.h>

namespace tether::energy {

double open_circuit_voltage_V(const Battery& battery, double charge) {
  const auto& points = battery.voltage_at_charge;
  std::size_t i = 1;
  while (i + 1 < points.size() && points[i].first < charge) ++i;
  const auto& [from, from_V] = points[i - 1];
  const auto& [to, to_V] = points[i];
  return from_V + (to_V - from_V) * (charge - from) / (to - from);
}

// P = (U − R I) I, of whose two currents the smaller one flows.
Discharge discharge(const Battery& battery, double charge, double power_W) {
  const double open_V = open_circuit_voltage_V(battery, charge);
  const double resistance = battery.resistance_ohm;
  Discharge now;
  if (charge <= 0.0) {
    now.voltage_V = open_V;
    now.is_exhausted = true;
    return now;
  }
  const double most_W = resistance > 0.0 ? open_V * open_V / (4.0 * resistance) : HUGE_VAL;
  now.power_W = std::min(power_W, most_W);
  // Without the difference of nearly equal numbers.
  const double root = std::sqrt(std::max(0.0, open_V * open_V - 4.0 * resistance * now.power_W));
  now.current_A = 2.0 * now.power_W / (open_V + root);
  now.voltage_V = open_V - resistance * now.current_A;
  now.heat_W = resistance * now.current_A * now.current_A;
  now.is_exhausted = power_W > most_W || now.voltage_V < battery.cut_off_V;
  return now;
}

}  // namespace tether::energy
