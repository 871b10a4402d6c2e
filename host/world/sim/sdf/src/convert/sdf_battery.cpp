#include "checks/sdf_check.h"
#include "convert/sdf_convert.h"

namespace tether::sim {
namespace {

constexpr double kSecondsPerHour = 3600.0;

double number_or(const SdfSource& source, const sdf::ElementPtr& plugin, const char* name,
                 double fallback) {
  return read_number(source, plugin, name).value_or(fallback);
}

}  // namespace

// Gazebo's model: the voltage falls linearly with the charge, V = e0 + e1 (1 − q/c) − R i.
std::optional<energy::Battery> read_battery(const SdfSource& source, const sdf::ElementPtr& model) {
  std::optional<energy::Battery> battery;
  for_each_child(model, [&](const sdf::ElementPtr& plugin) {
    if (!is_battery_plugin(plugin)) return;
    const double full_V = number_or(source, plugin, "open_circuit_voltage_constant_coef",
                                    number_or(source, plugin, "voltage", 0.0));
    const double empty_V =
        full_V + number_or(source, plugin, "open_circuit_voltage_linear_coef", 0.0);
    const double capacity_ah = number_or(source, plugin, "capacity", 0.0);
    const double charge_ah = number_or(source, plugin, "initial_charge", capacity_ah);
    const double resistance_ohm = number_or(source, plugin, "resistance", 0.0);
    if (capacity_ah <= 0.0 || charge_ah <= 0.0 || charge_ah > capacity_ah)
      refuse(source, plugin,
             "must have a <capacity> above 0 Ah, and an <initial_charge> above 0 and up to it");
    if (empty_V <= 0.0 || empty_V > full_V || resistance_ohm < 0.0)
      refuse(source, plugin,
             "must have a voltage above 0 V that does not rise as the charge falls, and no "
             "negative <resistance>");
    battery = {.capacity_C = kSecondsPerHour * capacity_ah,
               .voltage_at_charge = {{0.0, empty_V}, {1.0, full_V}},
               .resistance_ohm = resistance_ohm,
               .cut_off_V = 0.0,
               .initial_charge = charge_ah / capacity_ah};
  });
  return battery;
}

}  // namespace tether::sim
