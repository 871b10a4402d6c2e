#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>

#include <tether/sim/world.h>

namespace tether::scenario {

/// Whether a model is nested in the one of that name: it moves with it.
inline bool is_nested_in(const sim::Model& model, std::string_view name) {
  return model.name.starts_with(name) && model.name.substr(name.size()).starts_with("::");
}

/// Why a UAV that weighs so much cannot fly, for a person. Empty: it can.
inline std::string why_no_lift(const sim::Uav& uav, double mass_kg, const sim::World& world) {
  const double lift_N = uav::flight_limits(uav.airframe).max_thrust_N;
  const double weight_N = mass_kg * world.gravity_m_s2;
  if (lift_N > weight_N) return "";
  return fmt::format(
      "makes the UAV '{}' too heavy to fly: it weighs {:.3g} N ({:.3g} kg), and its rotors lift "
      "{:.3g} N at most",
      uav.name, weight_N, mass_kg, lift_N);
}

}  // namespace tether::scenario
