#include "tables/read_power.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include <tether/scenario/scenario.h>
#include <tether/toml/table.h>

namespace tether::scenario {
namespace {

constexpr toml::Range kPower_w{.min = 0.0, .max = 1e5};
constexpr toml::Range kShare{.min = 0.0, .max = 1.0};
constexpr double kSecondsPerHour = 3600.0;

energy::Propulsion read_rotor(const toml::Table& root) {
  const toml::Table table = root.table("rotor", {"radius_m", "induced_factor", "efficiency",
                                                 "nominal_voltage_v", "air_density_kg_m3"});
  energy::Propulsion rotor;
  rotor.rotor_radius_m = table.number("radius_m", {.min = 0.0, .max = 10.0, .above_min = true});
  rotor.induced_factor =
      table.number_or("induced_factor", {.min = 1.0, .max = 2.0}, rotor.induced_factor);
  rotor.efficiency = table.number("efficiency", {.min = 0.0, .max = 1.0, .above_min = true});
  rotor.nominal_voltage_V =
      table.number("nominal_voltage_v", {.min = 0.0, .max = 1e3, .above_min = true});
  rotor.air_density_kg_m3 = table.number_or(
      "air_density_kg_m3", {.min = 0.0, .max = 10.0, .above_min = true}, rotor.air_density_kg_m3);
  return rotor;
}

/// Lists of the same length: shares of the charge, and the voltage of a cell at each.
std::vector<std::pair<double, double>> read_voltages(const toml::Table& table, double cells) {
  constexpr toml::Range kVoltage_v{.min = 0.0, .max = 10.0, .above_min = true};
  const std::vector<double> charges = table.numbers("charge", kShare);
  const std::vector<double> voltages = table.numbers("cell_voltage_v", kVoltage_v);
  if (charges.size() < 2 || charges.front() != 0.0 || charges.back() != 1.0 ||
      !std::ranges::is_sorted(charges, std::less_equal<>()))
    table.fail("charge", "must rise from 0 to 1, with at least these two");
  if (voltages.size() != charges.size())
    table.fail("cell_voltage_v", fmt::format("has {} voltages, but 'charge' has {} values",
                                             voltages.size(), charges.size()));
  if (!std::ranges::is_sorted(voltages))
    table.fail("cell_voltage_v", "falls with the charge. A battery's voltage must not.");
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < charges.size(); ++i)
    points.emplace_back(charges[i], cells * voltages[i]);
  return points;
}

energy::Battery read_battery(const toml::Table& root) {
  const toml::Table table =
      root.table("battery", {"cells", "capacity_ah", "charge", "cell_voltage_v", "resistance_ohm",
                             "cut_off_cell_v", "initial_charge"});
  const auto cells = static_cast<double>(table.integer("cells", 1, 200));
  energy::Battery battery;
  battery.capacity_C =
      kSecondsPerHour * table.number("capacity_ah", {.min = 0.0, .max = 1e4, .above_min = true});
  battery.voltage_at_charge = read_voltages(table, cells);
  battery.resistance_ohm = table.number("resistance_ohm", {.min = 0.0, .max = 100.0});
  const double full_V = battery.voltage_at_charge.back().second;
  battery.cut_off_V = cells * table.number("cut_off_cell_v", {.min = 0.0, .max = 10.0});
  if (battery.cut_off_V >= full_V)
    table.fail("cut_off_cell_v", fmt::format("is {}, which the full cell's {} V must exceed",
                                             battery.cut_off_V / cells, full_V / cells));
  battery.initial_charge = table.number_or(
      "initial_charge", {.min = 0.0, .max = 1.0, .above_min = true}, battery.initial_charge);
  return battery;
}

energy::Computer read_computer(const toml::Table& root) {
  if (!root.has("computer")) return {};
  return read_power(root.table("computer", {"idle_w", "busy_core_w"}));
}

double read_constants(const toml::Table& root) {
  if (!root.has("constant")) return 0.0;
  const toml::Table table = root.table("constant");
  double sum_W = 0.0;
  for (const std::string& key : table.keys()) {
    if (!key.ends_with("_w"))
      table.fail(key, "must end with '_w', such as camera_w: a constant power in watts");
    sum_W += table.number(key, kPower_w);
  }
  return sum_W;
}

}  // namespace

energy::Computer read_power(const toml::Table& table) {
  return {table.number("idle_w", kPower_w), table.number("busy_core_w", kPower_w)};
}

Energy load_energy(const std::filesystem::path& file) {
  Energy energy;
  energy.file = std::filesystem::absolute(file).lexically_normal();
  const toml::Document document = toml::Document::load(energy.file);
  const toml::Table root =
      document.root({"name", "description", "rotor", "battery", "computer", "constant"});
  root.identifier("name");
  root.text_or("description", "");
  energy.model.propulsion = read_rotor(root);
  energy.rotor_at = root.where("rotor");
  energy.has_battery = root.has("battery");
  energy.battery_at = energy.has_battery ? root.where("battery") : root.where();
  if (energy.has_battery) energy.model.battery = read_battery(root);
  energy.model.computer = read_computer(root);
  energy.model.sensors_W = read_constants(root);
  return energy;
}

}  // namespace tether::scenario
